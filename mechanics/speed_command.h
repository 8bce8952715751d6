#pragma once

#include "mechanics/drives.h"

namespace twinbench::mechanics {

/// Angle and its derivatives by time at one instant of a motion.
struct Motion {
  double rad = 0.0;
  double rad_s = 0.0;
  double rad_s2 = 0.0;
  double rad_s3 = 0.0;
};

/// Commanded motion of a spindle: speeds with ramps between them. Begins at rest at angle 0.
class SpeedCommand {
 public:
  /// From `now` on the speed goes from what it is then to `speed_rad_s` along 3 s^2 - 2 s^3, s = time / ramp, so
  /// that a ramp that is not broken off begins and ends without acceleration.
  /// @throws std::invalid_argument unless the speed is finite and the ramp positive.
  void Run(double speed_rad_s, double ramp_s, Nanoseconds now);

  /// @param time  Not before the last Run.
  Motion At(Nanoseconds time) const;

  Nanoseconds ramp_end() const { return ramp_end_; }

 private:
  Nanoseconds start_ = 0;
  Nanoseconds ramp_end_ = 0;
  double from_rad_ = 0.0;
  double from_rad_s_ = 0.0;
  double gain_rad_s_ = 0.0;
  double ramp_s_ = 1.0;
};

}  // namespace twinbench::mechanics
