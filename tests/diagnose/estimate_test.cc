#include "twin/diagnose/engine/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/prior.h"

namespace twinbench::diagnose {
namespace {

constexpr double kAmplitude_m = 6.0 * units::um, kLifetime_s = 700.0;
constexpr int kSeeds = 200;
// Threshold of the search: size is asked for here, not presence.
constexpr double kAnything = -std::numeric_limits<double>::infinity();

double DecayAt(const Schedule& s, int reading, double lifetime_s) {
  return std::exp(-(s.time_s[reading] - s.time_s[0]) / lifetime_s);
}

/// A lateral shift that dies away over an unknown time.
Family Decay(const LinearRun& run) {
  Family family;
  family.effect = family.group = "decay";
  family.amplitudes = {{"amplitude", "um", units::um, 3.0 * units::um}};
  family.shapes = {{"lifetime", "s", 1.0, 50.0, 5000.0, {100.0, 300.0, 900.0, 2700.0}}};
  family.grid = 4;
  family.at = [&run](const Eigen::VectorXd& shape) {
    Eigen::MatrixXd column(run.Rows(), 1);
    for (int k = 0; k < run.Rows(); ++k) {
      column(k, 0) = run.patterns[3].weight[run.ChannelOf(k)] * DecayAt(run.schedule, run.ReadingOf(k), shape[0]);
    }
    return column;
  };
  family.columns = [at = family.at, value = family.shapes[0].value](int g) {
    return at(Eigen::VectorXd::Constant(1, value[static_cast<std::size_t>(g)]));
  };
  return family;
}

/// @param noise  Actual deviation over the stated one.
Term FindDecay(LinearRun run, std::uint64_t seed, double noise) {
  run.sigma *= noise;
  AddNoise(run, seed);
  run.sigma /= noise;
  const std::vector<Family> families = {Decay(run)};
  const NoiseModel model{run.sigma, 0.0};
  const Projector projector(model.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Scanner scanner(run, model, projector, families);
  return Search(run, model, projector, scanner, LogPriors(families), kAnything, 1).terms.at(0);
}

struct Coverage {
  double amplitude = 0.0, lifetime = 0.0;
};

Coverage CoverageOf95(double noise) {
  LinearRun run = SyntheticRun({});
  AddEffect(run, run.patterns[3].weight,
            [&](int i) { return kAmplitude_m * DecayAt(run.schedule, i, kLifetime_s); });
  Coverage share;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Term term = FindDecay(run, seed, noise);
    const auto covers = [&term](double value, double truth, int k) {
      return std::abs(value - truth) <= 1.96 * std::sqrt(term.cov(k, k)) ? 1.0 / kSeeds : 0.0;
    };
    share.amplitude += covers(term.amplitudes[0], kAmplitude_m, 0);
    share.lifetime += covers(term.shape[0], kLifetime_s, 1);
  }
  return share;
}

// 0.95 less three deviations of 200 runs is 0.90. A lifetime enters in curves, which costs a little more.
TEST(Estimate, IntervalsOfAnAmplitudeAndItsLifetimeHoldTheTruth) {
  const Coverage share = CoverageOf95(1.0);
  EXPECT_GE(share.amplitude, 0.90);
  EXPECT_GE(share.lifetime, 0.88);
}

TEST(Estimate, IntervalsGrowWhereTheNoiseIsLargerThanStated) {
  EXPECT_GE(CoverageOf95(1.6).amplitude, 0.90);
}

}  // namespace
}  // namespace twinbench::diagnose
