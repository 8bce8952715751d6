#include "twin/sim/driven_path.h"

#include <algorithm>
#include <cmath>

namespace twinbench::sim {

DrivenPath DrivenPath::Resting(std::vector<double> at, Time now) {
  DrivenPath path;
  path.from_ = path.to_ = std::move(at);
  path.knots_ = {{now, 1.0}};
  return path;
}

DrivenPath DrivenPath::Line(std::vector<double> from, std::vector<double> to, Time begin, Duration takes) {
  DrivenPath path;
  path.from_ = std::move(from);
  path.to_ = std::move(to);
  path.knots_ = {{begin, 0.0}, {begin + takes, 1.0}};
  return path;
}

DrivenPath DrivenPath::Circular(std::vector<double> from, const Arc& arc, std::vector<PathKnot> knots) {
  DrivenPath path;
  path.arc_ = arc;
  path.from_ = std::move(from);
  path.to_ = path.OnArc(1.0);
  path.knots_ = std::move(knots);
  return path;
}

DrivenPath DrivenPath::Turning(double from_rad, double from_speed_rad_s, double speed_rad_s, Time begin, Duration ramp) {
  DrivenPath path;
  path.turn_ = {from_rad, from_speed_rad_s, speed_rad_s, begin, ToSeconds(ramp)};
  const bool ends = speed_rad_s == 0.0;
  path.to_ = {ends ? Turned_rad(*path.turn_, begin + ramp) : kNaN};
  path.knots_ = {{ends ? begin + ramp : Time::max(), 1.0}};
  return path;
}

double DrivenPath::Turned_rad(const Turn& turn, Time now) {
  const double since_s = ToSeconds(now - turn.begin), in_ramp_s = std::clamp(since_s, 0.0, turn.ramp_s);
  const double gained_rad_s = turn.speed_rad_s - turn.from_speed_rad_s;
  const double of_ramp_rad = turn.from_speed_rad_s * in_ramp_s + 0.5 * gained_rad_s / turn.ramp_s * in_ramp_s * in_ramp_s;
  return turn.from_rad + of_ramp_rad + turn.speed_rad_s * (since_s - in_ramp_s);
}

double DrivenPath::TurningSpeed_rad_s(Time now) const {
  if (!turn_) return 0.0;
  const double share = std::clamp(ToSeconds(now - turn_->begin) / turn_->ramp_s, 0.0, 1.0);
  return turn_->from_speed_rad_s + share * (turn_->speed_rad_s - turn_->from_speed_rad_s);
}

std::vector<double> DrivenPath::At(Time now) const {
  if (turn_ && now < End()) return {Turned_rad(*turn_, now)};
  return AtShare(Share(now));
}

std::vector<double> DrivenPath::AtShare(double share) const {
  if (share >= 1.0) return to_;
  if (arc_) return OnArc(share);
  std::vector<double> at = from_;
  for (std::size_t k = 0; k < at.size(); ++k) at[k] += share * (to_[k] - from_[k]);
  return at;
}

double DrivenPath::Share(Time now) const {
  if (now >= End()) return 1.0;
  const auto after = std::ranges::upper_bound(knots_, now, {}, &PathKnot::time);
  if (after == knots_.begin()) return 0.0;
  const PathKnot &a = *(after - 1), &b = *after;
  return a.share + (b.share - a.share) * (ToSeconds(now - a.time) / ToSeconds(b.time - a.time));
}

std::vector<double> DrivenPath::OnArc(double share) const {
  const auto [i, j] = arc_->axes;
  const double dx_m = from_[i] - arc_->centre_m[0], dy_m = from_[j] - arc_->centre_m[1];
  const double c = std::cos(share * arc_->sweep_rad), s = std::sin(share * arc_->sweep_rad);
  std::vector<double> at = from_;
  at[i] = arc_->centre_m[0] + c * dx_m - s * dy_m;
  at[j] = arc_->centre_m[1] + s * dx_m + c * dy_m;
  return at;
}

}  // namespace twinbench::sim
