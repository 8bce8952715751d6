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
