#pragma once

namespace twinbench::mechanics {

/// Which coordinate of a circle an axis has to follow.
enum class CircleAxis { kX, kY };

/// What a control commands along a circle about the origin: its polar angle in time, at a constant rate that may be
/// come to along a ramp, 3 s^2 - 2 s^3 with s = time / ramp, as of SpeedCommand.
class CircleMotion {
 public:
  /// For ever at `rate_rad_s`, at `at_rad` when the time is `at_s`. A rate of zero is rest.
  CircleMotion(double radius_m, double at_rad, double rate_rad_s, double at_s);
  /// From that rate on to another within `ramp_s`; the way of the ramp is their mean times it.
  CircleMotion RampTo(double rate_rad_s, double at_s, double ramp_s) const;

  struct Point {
    double m = 0.0, m_s = 0.0;
  };
  Point At(CircleAxis axis, double time_s) const;
  double Angle_rad(double time_s) const;
  /// Polar angle less that at which the axis is at its largest coordinate.
  double Phase_rad(CircleAxis axis, double time_s) const;

  bool IsSteady() const { return ramp_s_ == 0.0; }
  double rate_rad_s() const { return rate_rad_s_; }
  double radius_m() const { return radius_m_; }

 private:
  struct Turn {
    double rad, rad_s;
  };
  Turn TurnAt(double time_s) const;

  double radius_m_, at_rad_, rate_rad_s_, at_s_;
  double gain_rad_s_ = 0.0, ramp_s_ = 0.0;
};

}  // namespace twinbench::mechanics
