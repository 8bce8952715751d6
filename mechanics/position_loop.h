#pragma once

namespace twinbench::mechanics {

/// Controller of a machine tool's axis: an angle controller (proportional) commands a speed controller
/// (proportional and integral), which commands a torque. Gains are free, or follow from an inertia: with w = 2 pi
/// servo_Hz, and f for feed_forward, angle over commanded angle of a free inertia is, as far as the period is
/// short,
///
///   H(s) = 5 w (s + w) (w + f s) / (s^3 + 5 w s^2 + 10 w^2 s + 5 w^3)
///
/// poles at -0.72 w and (-2.14 +- 1.53 j) w. At constant speed the integral leaves one error only:
/// the angle lags by (1 - f) speed / w, whatever the friction.
class PositionLoop {
 public:
  struct Gains {
    double position_1_s;
    double feed_forward;
    double proportional_Nm_s;  // torque by the speed's error
    double integral_Nm;        // and by its integral
  };

  PositionLoop(const Gains& gains, double period_s) : gains_(gains), period_s_(period_s) {}
  PositionLoop(double inertia_kg_m2, double servo_Hz, double feed_forward, double period_s);

  /// Torque [Nm] for the period to come.
  double Torque(double command_rad, double command_rad_s, double angle_rad, double speed_rad_s);

  double lag_s() const { return (1.0 - gains_.feed_forward) / gains_.position_1_s; }
  double left_rad() const { return left_rad_; }
  void set_left_rad(double left_rad) { left_rad_ = left_rad; }

 private:
  Gains gains_;
  double period_s_;
  double left_rad_ = 0.0;  // integral of the speed's error
};

}  // namespace twinbench::mechanics
