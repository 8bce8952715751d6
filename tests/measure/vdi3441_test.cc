#include "twin/benches/encoder_comparison/estimators/vdi3441.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/measure/positioning.h"

namespace twinbench::measure {
namespace {

using enum VdiValue;

VdiPositioning Evaluated(const std::vector<PositioningTarget>& targets) {
  return EvaluateVdi3441(EvaluatePositioning(targets, {.replicas = 0}).targets);
}

TEST(EvaluateVdi3441, GivesTheDefinitionsOnFiguresFoundByHand) {
  // Means 7 and -2, reversals 6 and 6, scatters 6 (1 + 2) / 2 = 9 and 6 (3 + 1) / 2 = 12.
  const VdiPositioning p = Evaluated({TwoRuns(10.0, 1.0, 4.0, 2.0), TwoRuns(-5.0, 3.0, 1.0, 1.0)});
  const std::map<VdiValue, double> by_hand = {{kP, 25.5},  // 7 + (6 + 9) / 2 - (-2 - (6 + 12) / 2)
                                              {kPs, 12.0},  {kMeanPs, 10.5}, {kPa, 9.0}, {kU, 6.0}, {kMeanU, 6.0}};
  for (const auto& [value, expected] : by_hand) EXPECT_NEAR(p[value].value, expected, 1e-13) << kVdiValueNames[static_cast<std::size_t>(value)];
}

/// Of one target P is U + Ps. Five runs a side with s = sqrt(2.5): s of five normal runs has the mean c4 s and the standard deviation
/// sqrt(1 - c4^2) s, c4 = 0.939986, and Ps = 3 (s+ + s-).
TEST(EvaluateVdi3441, StatesTheScatterOfOneTargetAsItsDistributionHasIt) {
  const double s = std::sqrt(2.5), c4 = 0.939986;
  const VdiPositioning p = Evaluated({{0.0, {9, 10, 11, 12, 13}, {-1, 0, 1, 2, 3}}});
  EXPECT_NEAR(p[kP].value, 10.0 + 6.0 * s, 1e-12);
  EXPECT_NEAR(p[kPs].value, 6.0 * s, 1e-12);
  EXPECT_EQ(p[kPa].value, 0.0);
  // 2000 replicas: u to 1.6 %, a mean to u / sqrt(2000); five times that.
  const double u_scatter = 3.0 * std::sqrt(2.0 * (1.0 - c4 * c4)) * s, u_reversal = std::sqrt(2.0 / 5.0) * s;
  EXPECT_NEAR(p[kPs].u, u_scatter, 0.08 * u_scatter);
  EXPECT_NEAR(p[kPs].bias, 6.0 * s * (c4 - 1.0), 5.0 * u_scatter / std::sqrt(2000.0));
  EXPECT_NEAR(p[kU].u, u_reversal, 0.08 * u_reversal);
  EXPECT_NEAR(p[kP].u, std::hypot(u_scatter, u_reversal), 0.08 * u_scatter);
}

/// What ISO 230-2 calls M and B are Pa and U here.
TEST(EvaluateVdi3441, SharesDeviationAndReversalWithIso230OnAPublishedTest) {
  const VdiPositioning p = Evaluated(PublishedLinearAxis());
  EXPECT_NEAR(p[kPa].value, 2.77e-5, 0.51e-8);  // half a unit of the last digit printed
  EXPECT_NEAR(p[kU].value, 1.22e-5, 0.51e-7);
  EXPECT_GE(p[kP].value, p[kPa].value);
  EXPECT_GE(p[kPs].value, p[kMeanPs].value);
}

TEST(EvaluateVdi3441, GivesNothingThatNeedsASideThatWasNotMeasured) {
  const VdiPositioning p = Evaluated({{0.0, {1, 2, 3}, {}}});
  for (const ScatteredValue& value : p.axis) EXPECT_TRUE(std::isnan(value.value));
  EXPECT_EQ(VdiText(p, {"deg", 1.0, "arcsec", 1.0}), "");
  EXPECT_TRUE(std::isnan(Evaluated({})[kP].value));
}

}  // namespace
}  // namespace twinbench::measure
