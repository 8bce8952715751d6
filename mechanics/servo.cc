#include "mechanics/servo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace twinbench::mechanics {

ServoGains ServoGains::For(double inertia_kg_m2, double servo_Hz) {
  const double w = 2.0 * std::numbers::pi * servo_Hz;
  return {inertia_kg_m2 * w * w, 1.4 * inertia_kg_m2 * w, 0.25 * inertia_kg_m2 * w * w * w};
}

Servo::Servo(const ServoGains& gains, double period_s, double limit_Nm)
    : gains_(gains), period_s_(period_s), limit_Nm_(limit_Nm) {}

double Servo::Torque(double error_rad, double error_rad_s, double feed_forward_Nm) {
  const double integral = integral_rad_s_ + period_s_ * error_rad;
  const double torque = gains_.proportional_Nm_rad * error_rad + gains_.derivative_Nm_s_rad * error_rad_s +
                        gains_.integral_Nm_rad_s * integral + feed_forward_Nm;
  if (std::abs(torque) > limit_Nm_) return std::copysign(limit_Nm_, torque);
  integral_rad_s_ = integral;
  return torque;
}

LuGreFriction::LuGreFriction(const FrictionParameters& parameters, double inertia_kg_m2)
    : parameters_(parameters),
      bristle_stiffness_Nm_rad_(parameters.coulomb_Nm / parameters.presliding_rad),
      bristle_damping_Nm_s_(2.0 * parameters.bristle_damping_ratio *
                            std::sqrt(bristle_stiffness_Nm_rad_ * inertia_kg_m2)) {}

double LuGreFriction::Torque(double speed_rad_s, double step_s) {
  const double viscous_Nm = parameters_.viscous_Nm_s * speed_rad_s;
  if (parameters_.coulomb_Nm == 0.0) return -viscous_Nm;
  const double slow = speed_rad_s / parameters_.stribeck_rad_s;
  const double slip_rad =  // bend at which the bristles slip
      parameters_.presliding_rad * (1.0 + (parameters_.static_ratio - 1.0) * std::exp(-slow * slow));
  const double end_rad = std::copysign(slip_rad, speed_rad_s);
  const double rate_1_s = std::abs(speed_rad_s) / slip_rad;
  const double before_rad = bend_rad_;
  bend_rad_ = end_rad + (bend_rad_ - end_rad) * std::exp(-rate_1_s * step_s);
  const double bend_rate_rad_s = (bend_rad_ - before_rad) / step_s;
  return -(bristle_stiffness_Nm_rad_ * bend_rad_ + bristle_damping_Nm_s_ * bend_rate_rad_s + viscous_Nm);
}

double Backlash::Follow(double encoder_rad) {
  rotor_rad_ = std::clamp(rotor_rad_, encoder_rad - half_rad_, encoder_rad + half_rad_);
  return rotor_rad_;
}

}  // namespace twinbench::mechanics
