#include "twin/benches/circular_motion/ranked.h"

#include <algorithm>
#include <cmath>
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

/// G(b), or G of the one direction there is, of what one error shows along the radius at one feed.
/// @param all_m   What all errors show at each point.
/// @param others  All errors but that one.
double Alone_m(const CircleAnalysis& a, const Iso230_4& of, const std::vector<double>& all_m, const CircleErrors& others) {
  std::vector<CirclePath> paths;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const CirclePoint& p = a.points[i];
    if (p.setup != of.setup || p.feed_m_s != of.feed_m_s) continue;
    if (paths.empty() || paths.back().pass != p.pass)
      paths.push_back({p.setup, p.pass, p.direction, p.is_bar, p.radius_m, p.feed_m_s, {}, p.has_angle, p.is_drive});
    const double radial_m = all_m[i] - Shown_m(p, others, a.fit.MountingOf(p.setup), a.known).x();
    PathPoint& point = paths.back().points.emplace_back();
    point.commanded_rad = p.commanded_rad;
    point.d_m = radial_m * p.Commanded_m() / p.radius_m;
  }
  return CircularDeviation_m(paths);
}

/// Of two axes that show their lags. What they have in common turns the circle, and is no error of the radius.
void AddMismatch(const CircleAnalysis& a, const Iso230_4& of, const std::vector<double>& all_m, const std::vector<ErrorValue>& errors,
                 std::vector<RankedError>& ranked) {
  const auto x = std::ranges::find(errors, "machine.lag_x_s", &ErrorValue::key), y = std::ranges::find(errors, "machine.lag_y_s", &ErrorValue::key);
  if (x == errors.end() || y == errors.end()) return;
  const Eigen::VectorXd slope = x->slope - y->slope;
  const double variance = a.fit.shared.Variance(slope);
  if (!std::isfinite(variance)) return;
  CircleErrors others = a.fit.errors;
  others.lag_s[0] = others.lag_s[1] = 0.5 * (others.lag_s[0] + others.lag_s[1]);
  const PartedVariance parts = a.fit.shared.Parted(slope);
  const double steps = parts.of_steps / parts.all, machine = parts.of_machine / parts.all;
  ranked.push_back({of.setup, of.feed_m_s, "servo mismatch (x less y)",
                    {"machine.servo_mismatch_s", "s", x->value - y->value, std::sqrt(variance), 1.0 - steps - machine, steps, machine, slope},
                    Alone_m(a, of, all_m, others)});
}

std::vector<RankedError> RankedAt(const CircleAnalysis& a, const Iso230_4& of, const std::vector<double>& all_m, const std::vector<ErrorValue>& errors) {
  std::vector<RankedError> ranked;
  double sum_m = 0.0;
  for (const auto& [key, name] : Kinds()) {
    const auto error = std::ranges::find(errors, key, &ErrorValue::key);
    if (error == errors.end() || !std::isfinite(error->u)) continue;
    ranked.push_back({of.setup, of.feed_m_s, name, *error, Alone_m(a, of, all_m, ErrorsWithout(a.fit, {key}))});
  }
  AddMismatch(a, of, all_m, errors, ranked);
  for (const RankedError& error : ranked) sum_m += error.alone_m;
  for (RankedError& error : ranked) error.share = sum_m > 0.0 ? error.alone_m / sum_m : 0.0;
  std::ranges::stable_sort(ranked, std::greater(), &RankedError::alone_m);
  return ranked;
}

}  // namespace

std::vector<RankedError> RankedErrors(const CircleAnalysis& a) {
  std::vector<RankedError> all;
  if (!a.IsFitted()) return all;
  const std::vector<ErrorValue> errors = ErrorsOf(a.fit);
  std::vector<double> all_m;
  for (const CirclePoint& p : a.points) all_m.push_back(Shown_m(p, a.fit.errors, a.fit.MountingOf(p.setup), a.known).x());
  for (const Iso230_4& d : a.deviations) std::ranges::move(RankedAt(a, d, all_m, errors), std::back_inserter(all));
  return all;
}

}  // namespace twinbench::benches::circular
