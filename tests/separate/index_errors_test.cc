#include "twin/separate/index_errors.h"

#include <gtest/gtest.h>

#include <random>

#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

using units::arcsec, units::deg;

TEST(MeansByPlace, TakesTheConstantsOfSetUpsFromCommonPlaces) {
  // Value = place + set-up, exactly; the third set-up meets the second at one place only.
  const auto value = [](int setup, double angle_deg) { return angle_deg + 1000.0 * setup * setup; };
  std::vector<IndexReading> readings;
  for (const double at : {0.0, 90.0, 180.0}) readings.push_back({0, at * deg, value(0, at)});
  for (const double at : {90.0, 180.0, 270.0}) readings.push_back({1, at * deg, value(1, at)});
  for (const double at : {270.0, 300.0}) readings.push_back({2, (at - 360.0) * deg, value(2, at)});
  const IndexErrors errors = MeansByPlace(readings);
  ASSERT_EQ(errors.Count(), 5);
  const std::vector<double> places_deg = {0.0, 90.0, 180.0, 270.0, 300.0};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(errors.position_rad[i], places_deg[i] * deg, 1e-7);
    EXPECT_NEAR(errors.value_rad[static_cast<Eigen::Index>(i)] - errors.value_rad[0], places_deg[i], 1e-9);
    EXPECT_EQ(errors.group[i], errors.group[0]);
  }
  EXPECT_EQ(errors.count, (std::vector<int>{1, 2, 2, 2, 1}));
}

TEST(MeansByPlace, KeepsSetUpsApartThatHaveNoPlaceInCommon) {
  const IndexErrors errors = MeansByPlace({{0, 0.0, 1.0}, {0, 1.0, 3.0}, {4, 2.0, 100.0}, {4, 3.0, 104.0}});
  EXPECT_EQ(errors.group[0], errors.group[1]);
  EXPECT_EQ(errors.group[2], errors.group[3]);
  EXPECT_NE(errors.group[0], errors.group[2]);
  EXPECT_TRUE(AboutGroups(errors, errors.value_rad).isApprox(Eigen::Vector4d(-1.0, 1.0, -2.0, 2.0)));
  EXPECT_TRUE(std::isnan(errors.u_reading_rad));  // nothing was read twice
}

TEST(MeansByPlace, StatesTheNoiseOfOneReading) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 0.3 * arcsec);
  std::vector<IndexReading> readings;
  for (int k = 0; k < 2000; ++k) readings.push_back({k % 2, (k / 4 % 100) * deg, 1e-5 * (k % 2) + normal(random)});
  // 2000 readings less 100 places and one constant: 1.6 % of one standard deviation.
  EXPECT_NEAR(MeansByPlace(readings).u_reading_rad, 0.3 * arcsec, 0.016 * 3.0 * 0.3 * arcsec);
}

}  // namespace
}  // namespace twinbench::separate
