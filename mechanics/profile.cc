#include "mechanics/profile.h"

#include <cmath>
#include <stdexcept>

namespace twinbench::mechanics {

QuinticProfile::QuinticProfile(double position_rad)
    : from_rad_(position_rad), to_rad_(position_rad), duration_s_(0.0) {}

QuinticProfile::QuinticProfile(double from_rad, double to_rad, double duration_s)
    : from_rad_(from_rad), to_rad_(to_rad), duration_s_(duration_s) {
  if (!std::isfinite(from_rad) || !std::isfinite(to_rad)) {
    throw std::invalid_argument("motion profile: positions must be finite");
  }
  if (!(duration_s > 0.0) || !std::isfinite(duration_s)) {
    throw std::invalid_argument("motion profile: the duration must be positive");
  }
}

ProfilePoint QuinticProfile::At(double time_s) const {
  if (time_s >= duration_s_) return {to_rad_, 0.0, 0.0};
  if (time_s <= 0.0) return {from_rad_, 0.0, 0.0};
  const double s = time_s / duration_s_;
  const double rest = 1.0 - s;
  const double speed = travel_rad() / duration_s_;
  const double position = from_rad_ + travel_rad() * s * s * s * (10.0 + s * (6.0 * s - 15.0));
  return {position, speed * 30.0 * s * s * rest * rest, speed / duration_s_ * 60.0 * s * rest * (1.0 - 2.0 * s)};
}

}  // namespace twinbench::mechanics
