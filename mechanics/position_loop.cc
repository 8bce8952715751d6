#include "mechanics/position_loop.h"

#include <numbers>

namespace twinbench::mechanics {
namespace {

PositionLoop::Gains GainsFor(double inertia_kg_m2, double servo_Hz, double feed_forward) {
  const double w = 2.0 * std::numbers::pi * servo_Hz;
  const double proportional_Nm_s = 5.0 * w * inertia_kg_m2;
  return {w, feed_forward, proportional_Nm_s, w * proportional_Nm_s};
}

}  // namespace

PositionLoop::PositionLoop(double inertia_kg_m2, double servo_Hz, double feed_forward, double period_s)
    : PositionLoop(GainsFor(inertia_kg_m2, servo_Hz, feed_forward), period_s) {}

double PositionLoop::Torque(double command_rad, double command_rad_s, double angle_rad, double speed_rad_s) {
  const double wanted_rad_s = gains_.position_1_s * (command_rad - angle_rad) + gains_.feed_forward * command_rad_s;
  const double error_rad_s = wanted_rad_s - speed_rad_s;
  left_rad_ += period_s_ * error_rad_s;
  return gains_.proportional_Nm_s * error_rad_s + gains_.integral_Nm * left_rad_;
}

}  // namespace twinbench::mechanics
