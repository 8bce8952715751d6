#pragma once

#include "twin/benches/encoder_comparison/settings.h"

namespace twinbench::sim {

/// A spindle that runs down without its drive, pass after pass; SpindleSettings says what acts on it.
class CoastingSpindle {
 public:
  explicit CoastingSpindle(const EncoderSettings& settings)
      : spindle_(settings.spindle), rest_s_(settings.encoder_procedure.rest_s) {}

  double Now_s() const { return time_s_; }

  /// When the shaft comes to an angle, asked in the order in which it comes there. The first of a pass is where it
  /// begins, a rest behind the last pass.
  /// @param start_rad_s  Its speed then, with its sign.
  double PassesAt_s(int pass, double shaft_rad, double start_rad_s);

 private:
  /// By the angle: d time = 1 / speed, d speed = acceleration / speed.
  struct Slope {
    double time_s, speed_rad_s;
  };
  Slope SlopeAt(double shaft_rad, double speed_rad_s) const;
  void MoveTo(double shaft_rad);  // one step of Runge and Kutta's fourth order

  SpindleSettings spindle_;
  double rest_s_;
  int pass_ = -1;
  double time_s_ = 0.0, shaft_rad_ = 0.0, speed_rad_s_ = 0.0;
};

}  // namespace twinbench::sim
