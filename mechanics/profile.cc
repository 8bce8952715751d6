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

QuinticProfile::QuinticProfile(const ProfilePoint& from, double to_rad, double duration_s)
    : QuinticProfile(from.position_rad, to_rad, duration_s) {
  entry_rad_ = from.velocity_rad_s * duration_s;
  entry_bend_rad_ = from.acceleration_rad_s2 * duration_s * duration_s;
}

/// What a motion that was under way adds: it begins with the given speed and bend and vanishes with both.
ProfilePoint QuinticProfile::EntryAt(double s) const {
  const double v = entry_rad_, a = entry_bend_rad_, t = duration_s_;
  const double c3 = -6.0 * v - 1.5 * a, c4 = 8.0 * v + 1.5 * a, c5 = -3.0 * v - 0.5 * a;
  return {s * (v + s * (0.5 * a + s * (c3 + s * (c4 + s * c5)))),
          (v + s * (a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / t,
          (a + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (t * t)};
}

ProfilePoint QuinticProfile::At(double time_s) const {
  if (time_s >= duration_s_) return {to_rad_, 0.0, 0.0};
  if (time_s <= 0.0 && from_rest()) return {from_rad_, 0.0, 0.0};
  const double s = time_s / duration_s_;
  const double rest = 1.0 - s;
  const double speed = travel_rad() / duration_s_;
  const double position = from_rad_ + travel_rad() * s * s * s * (10.0 + s * (6.0 * s - 15.0));
  const ProfilePoint point = {position, speed * 30.0 * s * s * rest * rest,
                              speed / duration_s_ * 60.0 * s * rest * (1.0 - 2.0 * s)};
  if (from_rest()) return point;
  const ProfilePoint entry = EntryAt(s);
  return {point.position_rad + entry.position_rad, point.velocity_rad_s + entry.velocity_rad_s,
          point.acceleration_rad_s2 + entry.acceleration_rad_s2};
}

}  // namespace twinbench::mechanics
