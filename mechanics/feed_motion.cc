#include "mechanics/feed_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/require.h"

namespace twinbench::mechanics {

CircleMotion::CircleMotion(double radius_m, double at_rad, double rate_rad_s, double at_s)
    : radius_m_(radius_m), at_rad_(at_rad), rate_rad_s_(rate_rad_s), at_s_(at_s) {
  RequirePositive(radius_m, "circle motion: radius_m");
  Require(std::isfinite(at_rad) && std::isfinite(rate_rad_s) && std::isfinite(at_s),
          "circle motion: angle, rate and time must be finite");
}

CircleMotion CircleMotion::RampTo(double rate_rad_s, double at_s, double ramp_s) const {
  RequirePositive(ramp_s, "circle motion: ramp_s");
  const Turn from = TurnAt(at_s);
  CircleMotion ramp(radius_m_, from.rad, from.rad_s, at_s);
  ramp.gain_rad_s_ = rate_rad_s - from.rad_s;
  ramp.ramp_s_ = ramp_s;
  return ramp;
}

CircleMotion::Turn CircleMotion::TurnAt(double time_s) const {
  const double t_s = time_s - at_s_;
  const Turn even = {at_rad_ + rate_rad_s_ * t_s, rate_rad_s_};
  if (ramp_s_ == 0.0 || t_s <= 0.0) return even;
  if (t_s >= ramp_s_) return {even.rad + gain_rad_s_ * (t_s - 0.5 * ramp_s_), even.rad_s + gain_rad_s_};
  const double s = t_s / ramp_s_;
  return {even.rad + gain_rad_s_ * ramp_s_ * s * s * s * (1.0 - 0.5 * s),
          even.rad_s + gain_rad_s_ * s * s * (3.0 - 2.0 * s)};
}

double CircleMotion::Angle_rad(double time_s) const {
  return TurnAt(time_s).rad;
}

double CircleMotion::Phase_rad(CircleAxis axis, double time_s) const {
  return Angle_rad(time_s) - (axis == CircleAxis::kX ? 0.0 : 0.5 * std::numbers::pi);
}

CircleMotion::Point CircleMotion::At(CircleAxis axis, double time_s) const {
  const Turn turn = TurnAt(time_s);
  const double c = radius_m_ * std::cos(turn.rad), s = radius_m_ * std::sin(turn.rad);
  if (axis == CircleAxis::kX) return {c, -s * turn.rad_s};
  return {s, c * turn.rad_s};
}

}  // namespace twinbench::mechanics
