#include "twin/diagnose/engine/noise_causes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/ring_run.h"
#include "twin/core/stream.h"

namespace twinbench::diagnose {
namespace {

using test::NoisyRing;
using test::WhiteNoise;

/// A run of white noise of the stated size, altered row by row.
template <class Alter>
std::vector<NoiseCause> CausesOf(std::uint64_t seed, const Alter& alter) {
  LinearRun run = NoisyRing(seed);
  alter(run);
  const NoiseModel noise = WhiteNoise(run);
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Eigen::VectorXd white = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  // Left out by the plain way: a row without weight.
  const auto without = [&](const std::vector<int>& left_out) {
    Eigen::MatrixXd jacobian = noise.Whiten(run, run.nuisance.jacobian);
    for (const int row : left_out) jacobian.row(row).setZero();
    const Projector others(jacobian.sparseView(), run.nuisance);
    Rest rest{others.Apply(white).col(0), others.Redundancy()};
    rest.redundancy(left_out).setZero();
    return rest;
  };
  return FindNoiseCauses(run, noise, without({}), without);
}

int CountAbove(const std::vector<NoiseCause>& causes, double log_bayes) {
  int count = 0;
  for (const NoiseCause& cause : causes) count += cause.log_bayes > log_bayes ? 1 : 0;
  return count;
}

TEST(FindNoiseCauses, HardlyEverRefutesWhiteNoise) {
  int refuted = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    refuted += CountAbove(CausesOf(seed, [](LinearRun&) {}), 6.0) > 0;
  EXPECT_LE(refuted, 1);
}

TEST(FindNoiseCauses, TakesAFewFarValuesForOutliersAndLeavesThemOut) {
  const auto causes = CausesOf(3, [](LinearRun& run) {
    for (const int row : {11, 47, 90}) run.residual[row] += 15.0 * run.sigma[row];
  });
  ASSERT_FALSE(causes.empty());
  EXPECT_EQ(causes.front().kind, NoiseCause::Kind::kOutliers);
  EXPECT_EQ(causes.front().outliers, (std::vector<int>{11, 47, 90}));
}

TEST(FindNoiseCauses, FindsOneThatBendsTheFitForItsNeighbours) {
  // Two free constants a position and one reading that is far off: without it, none of the others is.
  const auto causes = CausesOf(3, [](LinearRun& run) { run.residual[47] += 400.0 * run.sigma[47]; });
  ASSERT_FALSE(causes.empty());
  EXPECT_EQ(causes.front().kind, NoiseCause::Kind::kOutliers);
  EXPECT_EQ(causes.front().outliers, (std::vector<int>{47}));
  EXPECT_NEAR(causes.front().outlier_size, 400.0, 10.0);
}

TEST(FindNoiseCauses, TakesManyModeratelyFarValuesForTails) {
  const auto causes = CausesOf(4, [](LinearRun& run) {
    Stream stream(5, "tails");
    for (Eigen::Index k = 0; k < run.residual.size(); ++k) {
      run.residual[k] = run.sigma[k] * stream.Normal() / std::sqrt(stream.ChiSquared(3.0) / 3.0);
    }
  });
  ASSERT_FALSE(causes.empty());
  EXPECT_EQ(causes.front().kind, NoiseCause::Kind::kTails);
}

}  // namespace
}  // namespace twinbench::diagnose
