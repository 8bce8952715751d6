#include "mechanics/servo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace twinbench::mechanics {
namespace {

BristleLaw LawOf(const FrictionParameters& p, double inertia_kg_m2) {
  const double stiffness_Nm_rad = p.coulomb_Nm / p.presliding_rad;
  return {p.coulomb_Nm, p.static_ratio, p.stribeck_rad_s, p.presliding_rad,
          2.0 * p.bristle_damping_ratio * std::sqrt(stiffness_Nm_rad * inertia_kg_m2)};
}

}  // namespace

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

LuGreFriction::LuGreFriction(const FrictionParameters& p, double inertia_kg_m2)
    : bristles_(LawOf(p, inertia_kg_m2)), viscous_Nm_s_(p.viscous_Nm_s) {}

double LuGreFriction::Torque(double speed_rad_s, double step_s) {
  const double viscous_Nm = viscous_Nm_s_ * speed_rad_s;
  if (bristles_.law().coulomb == 0.0) return -viscous_Nm;
  return -(bristles_.Pull(speed_rad_s, step_s) + viscous_Nm);
}

double Backlash::Follow(double encoder_rad) {
  rotor_rad_ = std::clamp(rotor_rad_, encoder_rad - half_rad_, encoder_rad + half_rad_);
  return rotor_rad_;
}

}  // namespace twinbench::mechanics
