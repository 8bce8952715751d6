#include "mechanics/speed_command.h"

#include <cmath>
#include <stdexcept>

namespace twinbench::mechanics {

void SpeedCommand::Run(double speed_rad_s, double ramp_s, Nanoseconds now) {
  if (!std::isfinite(speed_rad_s)) throw std::invalid_argument("speed command: speed_rad_s must be finite");
  if (!(ramp_s > 0.0) || !std::isfinite(ramp_s))
    throw std::invalid_argument("speed command: ramp_s must be positive");
  const Motion here = At(now);
  from_rad_ = here.rad;
  from_rad_s_ = here.rad_s;
  gain_rad_s_ = speed_rad_s - here.rad_s;
  ramp_s_ = ramp_s;
  start_ = now;
  ramp_end_ = now + static_cast<Nanoseconds>(std::ceil(ramp_s * 1e9));
}

Motion SpeedCommand::At(Nanoseconds time) const {
  const double t_s = ToSeconds(time - start_);
  const double s = t_s / ramp_s_;
  if (s >= 1.0) {
    const double to_rad_s = from_rad_s_ + gain_rad_s_;
    return {from_rad_ - 0.5 * gain_rad_s_ * ramp_s_ + to_rad_s * t_s, to_rad_s, 0.0, 0.0};
  }
  const double a = gain_rad_s_ / ramp_s_;
  return {from_rad_ + from_rad_s_ * t_s + gain_rad_s_ * ramp_s_ * s * s * s * (1.0 - 0.5 * s),
          from_rad_s_ + gain_rad_s_ * s * s * (3.0 - 2.0 * s), 6.0 * a * s * (1.0 - s),
          6.0 * a / ramp_s_ * (1.0 - 2.0 * s)};
}

}  // namespace twinbench::mechanics
