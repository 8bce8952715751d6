#include "mechanics/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace twinbench::mechanics {
namespace {

TEST(QuinticProfile, RestsExactlyBeforeAndAfterTheMove) {
  const QuinticProfile profile(0.1, 0.3, 0.6);
  EXPECT_EQ(profile.At(-1.0).position_rad, 0.1);
  EXPECT_EQ(profile.At(0.6).position_rad, 0.3);
  EXPECT_EQ(profile.At(9.0).velocity_rad_s, 0.0);
}

TEST(QuinticProfile, SpeedAndAccelerationAreItsDerivatives) {
  const QuinticProfile profile(0.1, -0.3, 0.6);
  const double h = 1e-5;
  for (double t : {0.05, 0.2, 0.3, 0.55}) {
    const double speed = (profile.At(t + h).position_rad - profile.At(t - h).position_rad) / (2.0 * h);
    const double acceleration = (profile.At(t + h).velocity_rad_s - profile.At(t - h).velocity_rad_s) / (2.0 * h);
    // Central differences: h^2/6 times a third derivative below 60 travel/T^3 = 110, plus rounding 1e-16/h.
    EXPECT_NEAR(profile.At(t).velocity_rad_s, speed, 1e-8);
    EXPECT_NEAR(profile.At(t).acceleration_rad_s2, acceleration, 1e-6);
  }
}

TEST(QuinticProfile, StartsAndEndsWithoutSpeedOrJolt) {
  const QuinticProfile profile(0.0, 1.0, 1.0);
  // Acceleration grows as 60 s from its ends: 6e-8 after 1e-9 s.
  for (double t : {1e-9, 1.0 - 1e-9}) {
    EXPECT_NEAR(profile.At(t).velocity_rad_s, 0.0, 1e-15);
    EXPECT_NEAR(profile.At(t).acceleration_rad_s2, 0.0, 1e-7);
  }
}

TEST(QuinticProfile, PeaksAreThoseOfTheFifthDegree) {
  const QuinticProfile profile(0.0, 2.0, 0.5);
  double speed = 0.0;
  double acceleration = 0.0;
  for (int i = 0; i <= 10000; ++i) {
    speed = std::max(speed, profile.At(i * 0.5e-4).velocity_rad_s);
    acceleration = std::max(acceleration, profile.At(i * 0.5e-4).acceleration_rad_s2);
  }
  EXPECT_NEAR(speed, 15.0 / 8.0 * 2.0 / 0.5, 1e-9);  // the middle is a grid point
  // 10/sqrt(3); a grid of 1e-4 of the duration misses the peak by at most 1e-8 of its curvature
  EXPECT_NEAR(acceleration, 10.0 / std::sqrt(3.0) * 2.0 / 0.25, 1e-5);
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
  const double h = 1e-6;  // differences of the position are the speed, to the square of the step
  for (const double t : {0.05, 0.15, 0.25}) {
    const double slope = (stop.At(t + h).position_rad - stop.At(t - h).position_rad) / (2.0 * h);
    EXPECT_NEAR(slope, stop.At(t).velocity_rad_s, 1e-8);
    const double bend = (stop.At(t + h).velocity_rad_s - stop.At(t - h).velocity_rad_s) / (2.0 * h);
    EXPECT_NEAR(bend, stop.At(t).acceleration_rad_s2, 1e-6);
  }
}

TEST(QuinticProfile, RefusesADurationThatIsNotPositive) {
  EXPECT_THROW(QuinticProfile(0.0, 1.0, 0.0), std::invalid_argument);
  EXPECT_THROW(QuinticProfile(0.0, 1.0, -1.0), std::invalid_argument);
  EXPECT_THROW(QuinticProfile(0.0, std::nan(""), 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::mechanics
