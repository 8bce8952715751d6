#include "twin/procedure/turning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

constexpr double kShare = 0.1;        // of the way: what speeds are held to
constexpr double kRampShape = 0.25;   // of a change of speed times its time: by what ramps differ from straight ones
constexpr double kFlicker_rad = 1e-5;
constexpr double kStands = 0.1;       // of the way that is expected, and less

/// The integral of a straight ramp and what follows, from its begin.
double WayOfRamp(double t_s, double ramp_s, double from_rad_s, double to_rad_s) {
  if (t_s >= ramp_s) return 0.5 * (from_rad_s + to_rad_s) * ramp_s + to_rad_s * (t_s - ramp_s);
  return from_rad_s * t_s + 0.5 * (to_rad_s - from_rad_s) * t_s * t_s / ramp_s;
}

}  // namespace

double Turning::SpeedAt(const Command& c, double at_s) {
  const double share = c.ramp_s > 0.0 ? std::clamp((at_s - c.at_s) / c.ramp_s, 0.0, 1.0) : 1.0;
  return c.from_rad_s + share * (c.to_rad_s - c.from_rad_s);
}

void Turning::Told(Time before, Time after, double speed_rad_s, Duration ramp) {
  Command command{ToSeconds(before), ToSeconds(ramp), 0.0, speed_rad_s, ToSeconds(after - before)};
  if (!told_.empty()) command.from_rad_s = SpeedAt(told_.back(), command.at_s);
  told_.push_back(command);
}

double Turning::Way_rad(double from_s, double to_s) const {
  double way_rad = 0.0;
  for (std::size_t k = 0; k < told_.size(); ++k) {
    const Command& c = told_[k];
    const double begin_s = std::max(from_s, c.at_s), end_s = k + 1 < told_.size() ? std::min(to_s, told_[k + 1].at_s) : to_s;
    if (end_s <= begin_s) continue;
    way_rad += WayOfRamp(end_s - c.at_s, c.ramp_s, c.from_rad_s, c.to_rad_s) -
               WayOfRamp(begin_s - c.at_s, c.ramp_s, c.from_rad_s, c.to_rad_s);
  }
  return way_rad;
}

/// What times and the shapes of ramps leave open.
double Turning::Slack_rad(const Shown& now) const {
  double fastest_rad_s = 0.0, late_s = last_.late_s + now.late_s, shape_rad = 0.0;
  for (const Command& c : told_) {
    fastest_rad_s = std::max({fastest_rad_s, std::abs(c.from_rad_s), std::abs(c.to_rad_s)});
    const bool has_ended = c.at_s + c.late_s + c.ramp_s <= last_.at_s;
    if (has_ended) continue;
    late_s += c.late_s;
    shape_rad += kRampShape * std::abs(c.to_rad_s - c.from_rad_s) * c.ramp_s;
  }
  return fastest_rad_s * late_s + shape_rad + kFlicker_rad;
}

void Turning::Look(const MachineAxis& axis, double encoder_rad, Time before, Time after) {
  const Shown now{encoder_rad, ToSeconds(before), ToSeconds(after - before)};
  const double way_rad = encoder_rad - last_.encoder_rad;  // NaN at the first look
  const double told_rad = Way_rad(last_.at_s, now.at_s), slack_rad = Slack_rad(now);
  const double since_s = now.at_s - last_.at_s;
  last_ = now;
  const auto begun_since = std::ranges::find_if(told_, [&](const Command& c) { return c.at_s > now.at_s; });
  if (begun_since - told_.begin() > 1) told_.erase(told_.begin(), begun_since - 1);
  if (!(std::abs(way_rad - told_rad) > kShare * std::abs(told_rad) + slack_rad)) return;
  if (std::abs(way_rad) < kStands * std::abs(told_rad))
    throw DeviceFault(FaultKind::kStalled, axis.name, fmt::format("should turn, and stands at {:.6f} deg", encoder_rad / units::deg));
  throw DeviceFault(FaultKind::kFollowing, axis.name,
                    fmt::format("went {:.6g} deg in {:.3g} s and was commanded a speed by which it goes {:.6g} deg", way_rad / units::deg,
                                since_s, told_rad / units::deg));
}

}  // namespace twinbench::procedure
