#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/diagnose/screen/estimators.h"

namespace twinbench::diagnose {
namespace {

constexpr double kUm = units::um;

screen::VarianceComponents Fitted(const LinearRun& run, const std::vector<std::vector<int>>& sortings,
                                  int channel) {
  const NoiseModel noise{run.sigma, 0.0};
  const Projector projector = ProjectorOf(run, noise);
  return screen::FitVarianceComponents(screen::Simulate(run, noise, projector, 50, 1), sortings, channel);
}

/// Adds offsets of standard deviation `size_m` to one channel, one a group.
void AddOffsets(LinearRun& run, const std::vector<int>& group, double size_m, Stream& stream) {
  std::vector<double> offset(static_cast<std::size_t>(*std::max_element(group.begin(), group.end()) + 1));
  for (double& v : offset) v = size_m * stream.Normal();
  AddEffect(run, Eigen::Vector4d(1, 0, 0, 0),
            [&](int i) { return offset[static_cast<std::size_t>(group[static_cast<std::size_t>(i)])]; });
}

TEST(VarianceComponents, AreThoseOfTheAnalysisOfVarianceInABalancedDesign) {
  LinearRun run =
      SyntheticRun({.positions = 12, .shifts = {0}, .passes = {1, -1, 1, -1, 1, -1, 1, -1}, .free_tables = false});
  AddNoise(run, 3);
  Stream stream(3, "test.offsets");
  AddOffsets(run, run.schedule.pass, 0.4 * kUm, stream);
  const Eigen::VectorXd y = run.residual(Eigen::seqN(0, 96, 4));
  const Eigen::Map<const Eigen::MatrixXd> by_pass(y.data(), 12, 8);
  const Eigen::RowVectorXd mean = by_pass.colwise().mean();
  const double between = 12.0 * (mean.array() - mean.mean()).square().sum() / 7.0;
  const double within = (by_pass.rowwise() - mean).squaredNorm() / (8.0 * 11.0);
  const double sigma2 = run.sigma[0] * run.sigma[0];
  const screen::VarianceComponents fit = Fitted(run, {run.schedule.pass}, 0);
  // The iteration stops at 1e-3.
  EXPECT_NEAR(fit.variance[0] * sigma2 / ((between - within) / 12.0), 1.0, 5e-3);
  EXPECT_NEAR(fit.repeat * sigma2 / within, 1.0, 5e-3);
}

TEST(VarianceComponents, PartWhatPassesShareFromWhatPlacesShare) {
  const LinearRun clean = SyntheticRun({.positions = 12, .shifts = {0, 1, 5}, .passes = {1, -1, -1, 1, 1, -1}});
  std::vector<int> place;
  for (int i = 0; i < clean.schedule.Readings(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    place.push_back(clean.schedule.setup[k] * 12 + clean.schedule.position[k]);
  }
  constexpr int kRuns = 20;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    LinearRun run = clean;
    AddNoise(run, seed);
    Stream stream(seed, "test.offsets");
    AddOffsets(run, run.schedule.pass, 0.3 * kUm, stream);  // variance 1 in units of the noise
    AddOffsets(run, place, 0.15 * kUm, stream);             // 0.25
    mean += Fitted(run, {run.schedule.pass, place}, 0).variance / kRuns;
  }
  // 15 free directions of passes in 20 runs: sqrt(2 / 300) = 0.08; places keep 11 directions each: 0.25 to 0.04.
  EXPECT_NEAR(mean[0], 1.0, 0.3);
  EXPECT_NEAR(mean[1], 0.25, 0.12);
}

TEST(VarianceComponents, OfWhiteNoiseAreZeroWithinTheirUncertainty) {
  LinearRun run = SyntheticRun({});
  AddNoise(run, 5);
  const screen::VarianceComponents fit = Fitted(run, {run.schedule.setup, run.schedule.pass}, 1);
  EXPECT_TRUE(std::isnan(fit.u_variance[0]));  // offsets of the set-ups are free unknowns
  EXPECT_EQ(fit.variance[0], 0.0);
  EXPECT_LT(fit.variance[1], 3.0 * fit.u_variance[1]);
  // About 80 free directions a channel: sqrt(2 / 80) = 0.16.
  EXPECT_NEAR(fit.repeat, 1.0, 0.5);
}

}  // namespace
}  // namespace twinbench::diagnose
