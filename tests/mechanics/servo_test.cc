#include "mechanics/servo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace twinbench::mechanics {
namespace {

TEST(Servo, IntegralStopsWhileTheTorqueIsAtItsLimit) {
  Servo servo({1.0, 0.0, 100.0}, 1e-3, 2.0);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(servo.Torque(5.0, 0.0, 0.0), 2.0);
  EXPECT_EQ(servo.integral_rad_s(), 0.0);
  servo.Torque(0.5, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(servo.integral_rad_s(), 0.5e-3);
}

TEST(LuGreFriction, SlipsAtTheCoulombTorqueAndSticksLikeASpring) {
  FrictionParameters p;
  p.coulomb_Nm = 0.2;
  LuGreFriction slipping(p, 0.1);
  double torque = 0.0;
  for (int i = 0; i < 1000; ++i) torque = slipping.Torque(0.5, 1e-3);
  EXPECT_NEAR(torque, -0.2, 1e-12);  // 500 Stribeck speeds, 10 000 presliding lengths: fully slipped

  p.bristle_damping_ratio = 0.0;
  LuGreFriction sticking(p, 0.1);
  // 1 nrad bends the bristles by 1 nrad of 50 urad: torque = stiffness x bend to 1/50 000.
  EXPECT_NEAR(sticking.Torque(1e-6, 1e-3), -0.2 / 50e-6 * 1e-9, 1e-4 * 4e-6);
}

TEST(LuGreFriction, BreakawayExceedsCoulomb) {
  FrictionParameters p;
  p.coulomb_Nm = 0.2;
  LuGreFriction friction(p, 0.1);
  double largest = 0.0;
  for (int i = 0; i < 20000; ++i)
    largest = std::max(largest, -friction.Torque(1e-4, 1e-3));  // far below Stribeck speed
  EXPECT_NEAR(largest, 1.2 * 0.2, 0.01 * 0.24);                 // exp(-0.01) of the excess
}

TEST(LuGreFriction, IsStableForStepsFarLongerThanItsBristles) {
  FrictionParameters p;
  p.coulomb_Nm = 0.5;
  LuGreFriction friction(p, 0.1);
  // One step slides 2000 presliding lengths. The bristle damping acts while they bend, in the first step only.
  friction.Torque(1.0, 0.1);
  EXPECT_NEAR(friction.Torque(1.0, 0.1), -0.5, 1e-9);
  friction.Torque(-1.0, 0.1);
  EXPECT_NEAR(friction.Torque(-1.0, 0.1), 0.5, 1e-9);
}

TEST(Backlash, KeepsTheRotorUntilTheGapIsCrossedAndOfZeroWidthIsTheEncoder) {
  Backlash play(2e-5);
  EXPECT_DOUBLE_EQ(play.Follow(1.0), 1.0 - 1e-5);
  EXPECT_DOUBLE_EQ(play.Follow(1.0 - 1.5e-5), 1.0 - 1e-5);  // within the gap
  EXPECT_DOUBLE_EQ(play.Follow(0.5), 0.5 + 1e-5);
  Backlash none(0.0);
  EXPECT_EQ(none.Follow(0.123), 0.123);
  EXPECT_FALSE(none.active());
  EXPECT_DOUBLE_EQ(play.Follow(1.0), 1.0 - 1e-5);
}

}  // namespace
}  // namespace twinbench::mechanics
