#pragma once

#include "mechanics/bristles.h"
#include "mechanics/stack.h"

/// What turns and brakes a rotor: drive with controller, and friction.
namespace twinbench::mechanics {

/// Gains for an inertia and a bandwidth w = 2 pi servo_Hz. The closed loop has the poles of
/// s^3 + 1.4 w s^2 + w^2 s + w^3/4: a slow one at 0.43 w (a 30 Hz loop wins a decade in 28 ms) and a damped pair.
struct ServoGains {
  double proportional_Nm_rad = 0.0;
  double derivative_Nm_s_rad = 0.0;
  double integral_Nm_rad_s = 0.0;

  static ServoGains For(double inertia_kg_m2, double servo_Hz);
};

/// Digital controller of one table: angle and speed error in, torque out, held for a period. Its integral stops
/// while the torque is at the limit.
class Servo {
 public:
  Servo(const ServoGains& gains, double period_s, double limit_Nm);

  /// @param error_rad  Commanded minus read; `feed_forward_Nm` is what the commanded acceleration needs.
  double Torque(double error_rad, double error_rad_s, double feed_forward_Nm);
  double integral_rad_s() const { return integral_rad_s_; }
  void set_integral_rad_s(double integral_rad_s) { integral_rad_s_ = integral_rad_s; }

 private:
  ServoGains gains_;
  double period_s_;
  double limit_Nm_;
  double integral_rad_s_ = 0.0;
};

/// LuGre friction of one rotor.
class LuGreFriction {
 public:
  LuGreFriction(const FrictionParameters& parameters, double inertia_kg_m2);

  /// Torque on the rotor [Nm] after it moved at `speed_rad_s` for `step_s`.
  double Torque(double speed_rad_s, double step_s);
  void Reset() { bristles_.set_bend(0.0); }
  bool active() const { return bristles_.law().coulomb > 0.0 || viscous_Nm_s_ > 0.0; }

 private:
  Bristles bristles_;
  double viscous_Nm_s_;
};

/// Play between encoder and rotor: the rotor stays until the encoder has moved by the gap and then follows it.
class Backlash {
 public:
  explicit Backlash(double full_width_rad, double angle_rad = 0.0)
      : half_rad_(0.5 * full_width_rad), rotor_rad_(angle_rad) {}

  /// Rotor angle after the encoder went monotonically to `encoder_rad`.
  double Follow(double encoder_rad);
  double rotor_rad() const { return rotor_rad_; }
  bool active() const { return half_rad_ > 0.0; }

 private:
  double half_rad_;
  double rotor_rad_;
};

}  // namespace twinbench::mechanics
