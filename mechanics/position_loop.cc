#include "mechanics/position_loop.h"

#include <numbers>

namespace twinbench::mechanics {

PositionLoop::PositionLoop(double inertia_kg_m2, double servo_Hz, double feed_forward, double period_s)
    : position_1_s_(2.0 * std::numbers::pi * servo_Hz),
      feed_forward_(feed_forward),
      proportional_Nm_s_(5.0 * position_1_s_ * inertia_kg_m2),
      integral_Nm_(position_1_s_ * proportional_Nm_s_),
      period_s_(period_s) {}

double PositionLoop::Torque(double command_rad, double command_rad_s, double angle_rad, double speed_rad_s) {
  const double wanted_rad_s = position_1_s_ * (command_rad - angle_rad) + feed_forward_ * command_rad_s;
  const double error_rad_s = wanted_rad_s - speed_rad_s;
  left_rad_ += period_s_ * error_rad_s;
  return proportional_Nm_s_ * error_rad_s + integral_Nm_ * left_rad_;
}

}  // namespace twinbench::mechanics
