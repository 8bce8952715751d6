#include "mechanics/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace twinbench::mechanics {
namespace {

TEST(QuinticProfile, RestsExactlyBeforeAndAfterTheMove) {
  const QuinticProfile profile(0.1, 0.3, 0.6);
  EXPECT_EQ(profile.At(-1.0).position_rad, 0.1);
  EXPECT_EQ(profile.At(0.6).position_rad, 0.3);
  EXPECT_EQ(profile.At(9.0).velocity_rad_s, 0.0);
}

/// Speed and acceleration are the derivatives. Central differences: h^2/6 times a third derivative below
/// 60 travel/T^3 = 110, plus rounding 1e-15/h.
void ExpectDerivatives(const QuinticProfile& profile, const std::vector<double>& times_s) {
  const double h = 1e-6;
  for (const double t : times_s) {
    const ProfilePoint before = profile.At(t - h), after = profile.At(t + h);
    EXPECT_NEAR(profile.At(t).velocity_rad_s, (after.position_rad - before.position_rad) / (2.0 * h), 1e-8);
    EXPECT_NEAR(profile.At(t).acceleration_rad_s2, (after.velocity_rad_s - before.velocity_rad_s) / (2.0 * h),
                1e-6);
  }
}

TEST(QuinticProfile, IsThePolynomialOfFifthDegreeWithItsDerivatives) {
  const QuinticProfile profile(0.1, -0.3, 0.6);
  for (double s = 0.0; s <= 1.0; s += 0.05)  // whose speed and acceleration vanish at both ends
    EXPECT_NEAR(profile.At(0.6 * s).position_rad, 0.1 - 0.4 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 1e-15);
  ExpectDerivatives(profile, {0.05, 0.2, 0.3, 0.55});
  // The peak of the speed and, by 10 / sqrt(3), that of the acceleration.
  EXPECT_NEAR(profile.At(0.3).velocity_rad_s, 15.0 / 8.0 * -0.4 / 0.6, 1e-14);
  const double steepest_s = 0.6 * (0.5 - std::sqrt(1.0 / 12.0));
  EXPECT_NEAR(profile.At(steepest_s).acceleration_rad_s2, 10.0 / std::sqrt(3.0) * -0.4 / 0.36, 1e-13);
}

TEST(QuinticProfile, TakesAMotionUpWithItsSpeedAndBendAndBringsItToRest) {
  const QuinticProfile move(0.2, 2.0, 0.5);
  const ProfilePoint cut = move.At(0.2);
  const QuinticProfile stop(cut, cut.position_rad + 0.1, 0.3);
  EXPECT_FALSE(stop.from_rest());
  const ProfilePoint first = stop.At(0.0), last = stop.At(0.3);
  EXPECT_DOUBLE_EQ(first.position_rad, cut.position_rad);
  EXPECT_DOUBLE_EQ(first.velocity_rad_s, cut.velocity_rad_s);
  EXPECT_DOUBLE_EQ(first.acceleration_rad_s2, cut.acceleration_rad_s2);
  EXPECT_EQ(last.position_rad, cut.position_rad + 0.1);
  // Just before its end it is as good as there: speed and bend vanish with the square and the first power of what
  // is left, which is a millionth of the duration.
  EXPECT_NEAR(stop.At(0.3 * (1.0 - 1e-6)).velocity_rad_s, 0.0, 1e-9);
  EXPECT_NEAR(stop.At(0.3 * (1.0 - 1e-6)).acceleration_rad_s2, 0.0, 1e-2);
  ExpectDerivatives(stop, {0.05, 0.15, 0.25});
}

TEST(QuinticProfile, RefusesADurationThatIsNotPositive) {
  for (const double duration_s : {0.0, -1.0})
    EXPECT_THROW(QuinticProfile(0.0, 1.0, duration_s), std::invalid_argument);
  EXPECT_THROW(QuinticProfile(0.0, std::nan(""), 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::mechanics
