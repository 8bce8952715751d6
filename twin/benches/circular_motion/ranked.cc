#include "twin/benches/circular_motion/ranked.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;

/// Keys of a kind, and what users call it.
const std::vector<std::pair<std::string, std::string>>& Kinds() {
  static const std::vector<std::pair<std::string, std::string>> kinds = {
      {"machine.squareness_arcsec", "squareness"},      {"machine.backlash_x_um", "backlash x"},
      {"machine.backlash_y_um", "backlash y"},          {"machine.spike_x_um", "reversal spikes x"},
      {"machine.spike_y_um", "reversal spikes y"},      {"machine.scale_mismatch_um_m", "scale mismatch (x less y)"},
      {"machine.scale_x_um_m", "scale x"},              {"machine.scale_y_um_m", "scale y"},
      {"machine.servo_mismatch_s", "servo mismatch (x less y)"},
      {"machine.cyclic_x_um", "cyclic error x"},        {"machine.cyclic_y_um", "cyclic error y"},
      {"machine.straightness_x_um", "straightness x"},  {"machine.straightness_y_um", "straightness y"},
      {"machine.straightness3_x_um", "straightness x (S)"}, {"machine.straightness3_y_um", "straightness y (S)"}};
  return kinds;  // constant
}

/// G(b), or G of the one direction there is, of what a kind shows along the radius at one feed.
double Alone_m(const CircleAnalysis& a, const Iso230_4& of, const std::string& key) {
  const CircleErrors others = ErrorsWithout(a.fit, {key});
  std::vector<CirclePath> paths;
  for (const CirclePoint& p : a.points) {
    if (p.setup != of.setup || p.feed_m_s != of.feed_m_s) continue;
    if (paths.empty() || paths.back().pass != p.pass)
      paths.push_back({p.setup, p.pass, p.direction, p.is_bar, p.radius_m, p.feed_m_s, {}, p.has_angle});
    const CircleMounting& mounting = a.fit.MountingOf(p.setup);
    const double radial_m = (Shown_m(p, a.fit.errors, mounting, a.known) - Shown_m(p, others, mounting, a.known)).x();
    PathPoint& point = paths.back().points.emplace_back();
    point.commanded_rad = p.commanded_rad;
    point.d_m = radial_m * p.Commanded_m() / p.radius_m;
  }
  return CircularDeviation_m(paths);
}

std::vector<RankedError> RankedAt(const CircleAnalysis& a, const Iso230_4& of, const std::vector<ErrorValue>& errors) {
  std::vector<RankedError> ranked;
  double sum_m = 0.0;
  for (const auto& [key, name] : Kinds()) {
    const auto error = std::ranges::find(errors, key, &ErrorValue::key);
    if (error == errors.end() || !std::isfinite(error->u)) continue;
    ranked.push_back({of.setup, of.feed_m_s, name, *error, Alone_m(a, of, key)});
    sum_m += ranked.back().alone_m;
  }
  for (RankedError& error : ranked) error.share = sum_m > 0.0 ? error.alone_m / sum_m : 0.0;
  std::ranges::stable_sort(ranked, std::greater(), &RankedError::alone_m);
  return ranked;
}

}  // namespace

std::vector<RankedError> RankedErrors(const CircleAnalysis& a) {
  std::vector<RankedError> all;
  if (!a.IsFitted()) return all;
  const std::vector<ErrorValue> errors = ErrorsOf(a.fit);
  for (const Iso230_4& d : a.deviations) std::ranges::move(RankedAt(a, d, errors), std::back_inserter(all));
  return all;
}

}  // namespace twinbench::benches::circular
