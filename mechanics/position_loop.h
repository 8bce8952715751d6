#pragma once

namespace twinbench::mechanics {

/// Controller of a machine tool's axis: an angle controller (proportional) commands a speed controller
/// (proportional and integral), which commands a torque. With w = 2 pi servo_Hz, and f for feed_forward, angle over
/// commanded angle of a free inertia is, as far as the period is short,
///
///   H(s) = 5 w (s + w) (w + f s) / (s^3 + 5 w s^2 + 10 w^2 s + 5 w^3)
///
/// poles at -0.72 w and (-2.14 +- 1.53 j) w. At constant speed the integral leaves one error only:
/// the angle lags by (1 - f) speed / w, whatever the friction.
class PositionLoop {
 public:
  PositionLoop(double inertia_kg_m2, double servo_Hz, double feed_forward, double period_s);

  /// Torque [Nm] for the period to come.
  double Torque(double command_rad, double command_rad_s, double angle_rad, double speed_rad_s);

  double lag_s() const { return (1.0 - feed_forward_) / position_1_s_; }

 private:
  double position_1_s_;
  double feed_forward_;
  double proportional_Nm_s_;
  double integral_Nm_;
  double period_s_;
  double left_rad_ = 0.0;  // integral of the speed's error
};

}  // namespace twinbench::mechanics
