#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/analysis.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/estimators/far_radii.h"
#include "twin/benches/circular_motion/ranked.h"
#include "twin/core/reading_clock.h"
#include "twin/report/far_readings.h"
#include "twin/report/json_units.h"
#include "twin/report/polar_text.h"
#include "twin/report/sound.h"
#include "twin/report/uncertainty_parts.h"

namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;
using nlohmann::json;
using report::In;
using units::um;

json WithUncertainty(double value, double u, double unit) {
  return {{"value", In(unit, value)}, {"u", In(unit, u)}};
}

/// Shares of u^2; the rest is noise of the instruments.
json PartsOf(double quantisation, double repeatability, double model) {
  return report::PartsJson({{"noise", 1.0 - quantisation - repeatability - model},
                            {"quantisation", quantisation},
                            {"repeatability", repeatability},
                            {"model", model}});
}

/// As scenarios call it.
template <class PointOrPath>
std::string InstrumentOf(const PointOrPath& of) {
  return of.is_drive ? "drive" : !of.is_bar ? "grid" : of.has_angle ? "bar" : "radial_bar";
}

const CirclePoint& FirstOf(const CircleAnalysis& a, int setup) {
  return *std::ranges::find(a.points, setup, &CirclePoint::setup);
}

/// What was fitted of a set-up.
void AddMounting(const CircleFit& fit, const CirclePoint& first, json& entry) {
  const int setup = first.setup;
  const CircleMounting& m = fit.MountingOf(setup);
  const Eigen::Index from = fit.UnknownOf(setup);
  const auto value = [&](Eigen::Index k, double of, double unit) {
    const bool known = fit.identified[static_cast<std::size_t>(from + k)];
    const PartedVariance variance = fit.shared.Parted(Eigen::VectorXd::Unit(fit.shared.cov.rows(), from + k));
    json entry_of = WithUncertainty(of, known ? std::sqrt(variance.all) : kNaN, unit);
    if (known) entry_of["u_parts"] = PartsOf(variance.of_steps / variance.all, variance.of_machine / variance.all, 0.0);
    return entry_of;
  };
  entry["offset_x_um"] = value(0, m.offset_m[0], um);
  entry["offset_y_um"] = value(1, m.offset_m[1], um);
  if (first.is_bar) {
    if (first.has_angle) entry["encoder_zero_deg"] = value(2, m.rotation_rad, units::deg);
    entry["length_error_um"] = value(3, m.length_m, um);
  } else if (!first.is_drive) {
    entry["rotation_arcsec"] = value(2, m.rotation_rad, units::arcsec);
  }
}

json SetupsJson(const CircleAnalysis& a) {
  json setups = json::array();
  std::vector<int> numbers;
  for (const CirclePoint& p : a.points) {
    if (numbers.empty() || numbers.back() != p.setup) numbers.push_back(p.setup);
  }
  for (const int setup : numbers) {
    const CirclePoint& first = FirstOf(a, setup);
    json entry = {
        {"setup", setup}, {"instrument", InstrumentOf(first)}, {"radius_mm", first.radius_m / units::mm}};
    if (a.IsFitted()) AddMounting(a.fit, first, entry);
    if (first.is_bar) {
      const Eigen::Vector2d& offset_m = a.published_offset_m.at(setup);
      entry["published_offset_um"] = {offset_m.x() / um, offset_m.y() / um};
    }
    setups.push_back(entry);
  }
  return setups;
}

json ErrorsJson(const std::vector<ErrorValue>& errors) {
  json all = json::object();
  for (const ErrorValue& e : errors) {
    if (!std::isfinite(e.u)) continue;  // the readings do not show it
    all[e.key] = {{"value", In(1.0, e.value)},
                  {"u", In(1.0, e.u)},
                  {"unit", e.unit},
                  {"u_parts", PartsOf(e.quantisation, e.repeatability, 0.0)}};
  }
  return all;
}

/// All errors that the run shows, together: they are made of the same unknowns.
uncertainty::Joint JointOf(const CircleFit& fit) {
  uncertainty::Joint joint{"errors", {}, {}};
  std::vector<Eigen::VectorXd> slopes;
  for (const ErrorValue& e : ErrorsOf(fit)) {
    if (!std::isfinite(e.u)) continue;
    joint.names.push_back("errors." + e.key);
    slopes.push_back(e.slope);
  }
  Eigen::MatrixXd by_unknowns(std::ssize(slopes), fit.shared.cov.rows());
  for (std::size_t i = 0; i < slopes.size(); ++i)
    by_unknowns.row(static_cast<Eigen::Index>(i)) = slopes[i].transpose();
  joint.cov = by_unknowns * fit.shared.cov * by_unknowns.transpose();
  return joint;
}

double Feed_mm_min(double feed_m_s) {
  return feed_m_s * 60.0 / units::mm;
}

std::string FeedText(double feed_m_s) {
  return feed_m_s > 0.0 ? fmt::format("{:.6g} mm/min", Feed_mm_min(feed_m_s)) : "at rest";
}

/// What the page draws: the uncertainty is one number a pass, so that thousands of points are no results of their own.
json RadialJson(const CirclePath& path, const SharedUncertainty& shared) {
  json entry = {{"setup", path.setup}, {"pass", path.pass}, {"direction", path.direction}, {"instrument", InstrumentOf(path)},
                {"radius_mm", path.radius_m / units::mm}, {"feed_mm_min", In(1.0, Feed_mm_min(path.feed_m_s))}};
  double squares_m2 = 0.0;
  for (const PathPoint& point : path.points) {
    entry["commanded_deg"].push_back(In(units::deg, point.commanded_rad));
    entry["radial_um"].push_back(In(um, point.Radial_m()));
    squares_m2 += std::pow(RadialUncertainty_m(point, shared), 2);
  }
  entry["u_radial_um"] = In(um, std::sqrt(squares_m2 / static_cast<double>(path.points.size())));
  return entry;
}

json PathJson(const CirclePath& path, const SharedUncertainty& shared) {
  json entry = {{"setup", path.setup}, {"pass", path.pass}};
  for (const PathPoint& point : path.points) {
    entry["commanded_deg"].push_back(point.commanded_rad / units::deg);
    if (!path.has_angle) {
      entry["radial_um"].push_back(In(um, point.Radial_m()));
      entry["u_radial_um"].push_back(In(um, RadialUncertainty_m(point, shared)));
      continue;
    }
    const Eigen::Vector2d u_m = Uncertainty_m(point, shared);
    entry["dx_um"].push_back(In(um, point.d_m.x()));
    entry["dy_um"].push_back(In(um, point.d_m.y()));
    entry["u_dx_um"].push_back(In(um, u_m.x()));
    entry["u_dy_um"].push_back(In(um, u_m.y()));
  }
  return entry;
}

json IsoJson(const CircleAnalysis& a, const Iso230_4& d) {
  const CirclePoint& first = FirstOf(a, d.setup);
  json entry = {{"setup", d.setup},
                {"instrument", InstrumentOf(first)},
                {"radius_mm", first.radius_m / units::mm},
                {"feed_mm_min", Feed_mm_min(d.feed_m_s)},
                {"edition", "ISO 230-4:2022; H as ISO 230-4:1996"}};
  for (const auto& [name, value] : NamedValues(d)) {
    if (!std::isfinite(value.value_m)) continue;  // a direction is missing
    entry[name + "_um"] = In(um, value.value_m);
    entry["u_" + name + "_um"] = In(um, value.u_m);
    if (std::isfinite(value.u_m)) entry["u_parts"][name + "_um"] = PartsOf(value.quantisation, value.repeatability, value.model);
  }
  return entry;
}

json BiasJson(const std::vector<PathBias>& all) {
  json list = json::array();
  for (const PathBias& b : all)
    list.push_back({{"setup", b.setup},
                    {"pass", b.pass},
                    {"radial_rms_um", In(um, b.radial_m)},
                    {"tangential_rms_um", In(um, b.tangential_m)},
                    {"noise_radial_um", In(um, b.u_radial_m)},
                    {"noise_tangential_um", In(um, b.u_tangential_m)},
                    {"status", b.IsBiased() ? "biased" : "within_noise"}});
  return list;
}

std::string BiasText(const CircleAnalysis& a) {
  if (a.IsFitted()) return "";
  if (a.method_bias.empty())
    return "published: the readings are too few to say how far the equations hold; no uncertainties\n";
  std::string text;
  for (const PathBias& b : a.method_bias) {
    if (b.IsBiased())
      text += fmt::format(
          "published path, mounting {}, pass {}: BIASED, {:.3g} um along and {:.3g} um across the radius from "
          "weighted least squares (exact model), where a reading's noise is {:.2g} and {:.2g}; included in its uncertainty\n",
          b.setup, b.pass, b.radial_m / um, b.tangential_m / um, b.u_radial_m / um, b.u_tangential_m / um);
  }
  return text;
}

/// Of the channels that there are.
json ResidualsJson(const CircleFit& fit) {
  json rms = json::object();
  const auto add = [&rms](const char* key, double value, double unit) {
    if (std::isfinite(value)) rms[key] = value / unit;
  };
  add("bar_um", fit.rms_bar_m, um);
  add("encoder_arcsec", fit.rms_encoder_rad, units::arcsec);
  add("grid_um", fit.rms_grid_m, um);
  return rms;
}

json RankedJson(const std::vector<RankedError>& ranked) {
  json list = json::array();
  for (const RankedError& e : ranked)
    list.push_back({{"setup", e.setup},
                    {"feed_mm_min", Feed_mm_min(e.feed_m_s)},
                    {"error", e.name},
                    {"key", e.size.key},
                    {"value", In(1.0, e.size.value)},
                    {"u", In(1.0, e.size.u)},
                    {"u_parts", PartsOf(e.size.quantisation, e.size.repeatability, 0.0)},
                    {"unit", e.size.unit},
                    {"share_um", In(um, e.alone_m)},
                    {"share", In(1.0, e.share)}});
  return list;
}

/// "-0.00049970 ± 0.00000052": both to the second digit of u.
std::string ToDigitsOfU(double value, double u) {
  constexpr int kMost = 12;
  const int decimals = u > 0.0 && std::isfinite(u) ? std::clamp(1 - static_cast<int>(std::floor(std::log10(u))), 0, kMost) : 6;
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, u, decimals);
}

/// Those that stand out of their uncertainty.
std::string RankedText(const std::vector<RankedError>& ranked) {
  std::string text;
  const RankedError* last = nullptr;
  for (const RankedError& e : ranked) {
    if (!e.IsSignificant()) continue;
    if (!last || last->setup != e.setup || last->feed_m_s != e.feed_m_s)
      text += fmt::format("Ranked by G(b) of each alone, mounting {}, {}; the centre is no error:\n", e.setup, FeedText(e.feed_m_s));
    text += fmt::format("  {:<26} {:>24} {:<8} {:8.3f} µm {:4.0f} %\n", e.name, ToDigitsOfU(e.size.value, e.size.u), e.size.unit, e.alone_m / um, 100.0 * e.share);
    last = &e;
  }
  return text;
}

json SeparationJson(const CircleAnalysis& a) {
  json separation = {{"setups", SetupsJson(a)},
                     {"errors", json::object()},
                     {"path", json::array()},
                     {"iso230_4", json::array()},
                     {"not_separable", json::array()}};
  if (a.IsFitted()) {
    separation["errors"] = ErrorsJson(ErrorsOf(a.fit));
    separation["not_separable"] = a.fit.not_separable;
    separation["residual_rms"] = ResidualsJson(a.fit);
    separation["dof"] = a.fit.dof;
  }
  for (const CirclePath& path : a.paths) separation["path"].push_back(PathJson(path, a.fit.shared));
  for (const Iso230_4& d : a.deviations) separation["iso230_4"].push_back(IsoJson(a, d));
  if (const BarAgainstGrid grid = CompareWithGrid(a.paths); grid.pairs > 0)
    separation["comparison"] = {{"radial_max_um", In(um, grid.radial_max_m)},
                              {"tangential_max_um", In(um, grid.tangential_max_m)}};
  return separation;
}

std::string LagInWords(const std::string& kind) {
  return kind == "fixed_delay" ? "a fixed delay" : kind == "first_order" ? "of first order" : "of first order, or a fixed delay: ambiguous in this run";
}

std::string ErrorsText(const CircleAnalysis& a) {
  std::string text;
  for (const ErrorValue& e : ErrorsOf(a.fit))
    text += std::isfinite(e.u) ? fmt::format("{:<34} {:>24} {}\n", e.key, ToDigitsOfU(e.value, e.u), e.unit) : "";
  for (const std::string& words : a.fit.not_separable) text += "not separable: " + words + "\n";
  if (!a.lag_kind.empty()) text += "lag: " + LagInWords(a.lag_kind) + "\n";
  text += fmt::format("residual, in stated uncertainties: {:.3f} rms\n", a.fit.chi);
  if (a.fit.chi > report::kMostMisfit)
    text += "the errors above do not describe the readings: their uncertainties are those of what is left, taken as noise that goes on from reading to reading; `diagnose` says what it is\n";
  return text;
}

std::string DeviationsText(const CircleAnalysis& a) {
  std::string text = "ISO 230-4:2022 (H: 1996) [µm], F about the least-squares circle's centre:\n";
  for (const Iso230_4& d : a.deviations) {
    text += fmt::format("  mounting {}, {}:", d.setup, FeedText(d.feed_m_s));
    for (const auto& [name, value] : NamedValues(d)) {
      if (std::isfinite(value.value_m)) text += fmt::format(" {} {:.3f}", name, value.value_m / um);
    }
    text += "\n";
  }
  return text;
}

/// Radial deviation of the paths of one set-up and feed: + counter-clockwise, o clockwise.
std::string PolarOf(const std::vector<CirclePath>& all, const Iso230_4& of) {
  std::vector<report::PolarSeries> series;
  std::string title;
  for (const CirclePath& path : all) {
    if (path.setup != of.setup || path.feed_m_s != of.feed_m_s) continue;
    report::PolarSeries& s = series.emplace_back(report::PolarSeries{path.direction > 0 ? '+' : 'o', {}, {}});
    for (const PathPoint& point : path.points) {
      s.angle_rad.push_back(point.commanded_rad);
      s.value.push_back(point.Radial_m() / um);
    }
    title = fmt::format("mounting {}, {}, R = {:.3f} mm, {}: radial deviation, + counter-clockwise, o clockwise\n",
                        path.setup, InstrumentOf(path), path.radius_m / units::mm, FeedText(of.feed_m_s));
  }
  return title + report::PolarText(series, "um") + "\n";
}

std::string PolarsOf(const CircleAnalysis& a) {
  std::string text;
  for (const Iso230_4& d : a.deviations) text += PolarOf(a.paths, d);
  return text;
}

/// Passes whose places go the other way round than their rows say, by the clock: " (pass 1 says cw, and ...)"; empty: none.
std::string OtherWays(const std::vector<Reading>& readings) {
  if (!HasClock(readings)) return "";
  std::string text;
  std::map<std::pair<int, int>, double> along_rad;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Reading &before = readings[i - 1], &r = readings[i];
    if (before.setup != r.setup || before.pass != r.pass) continue;
    const double step_rad = std::remainder(WithAngle(nullptr, r).target_rad - WithAngle(nullptr, before).target_rad, units::turn);
    along_rad[{r.setup, r.pass}] += r.direction * step_rad;
  }
  for (const auto& [pass, rad] : along_rad)
    if (rad < -0.5 * units::turn) text += fmt::format("{}mounting {}, pass {}", text.empty() ? "" : "; ", pass.first, pass.second);
  return text.empty() ? "" : " (places go the other way round than the rows say: " + text + ")";
}

/// What was read of lengths and times other than the scenario states them; in words one a line.
struct ShapesAsRead {
  json values = json::object();
  std::string text;
};
ShapesAsRead ShapesOf(const CircleAnalysis& a, const CircularMachineSettings& stated) {
  ShapesAsRead shapes;
  if (!a.IsFitted()) return shapes;
  if (a.known.pitch_m != stated.cyclic_pitch_m) {
    shapes.values["cyclic_pitch_mm"] = In(units::mm, a.known.pitch_m);
    shapes.text += fmt::format("cyclic errors have a pitch of {:.4g} mm by the readings, not of {:.4g} mm as the scenario states\n",
                               a.known.pitch_m / units::mm, stated.cyclic_pitch_m / units::mm);
  }
  if (a.known.spike_time_s != stated.spike_time_s) {
    shapes.values["spike_time_s"] = In(1.0, a.known.spike_time_s);
    shapes.text += fmt::format("spikes behind reversals are largest after {:.3g} s by the readings, not after {:.3g} s as the scenario states\n",
                               a.known.spike_time_s, stated.spike_time_s);
  }
  return shapes;
}

/// G, F, D and H are of the radii as they were read, and errors widen their uncertainty by what they leave: of radii alone that is no reason to
/// have nothing. Where rows contradict their clock, or an angle does what is shown, it is.
report::Misfit MisfitOf(const CircleAnalysis& a, const std::string& other_ways) {
  const std::string of = "the joint fit of the circles" + other_ways;
  const bool is_radius = std::ranges::none_of(a.points, &CirclePoint::has_angle);
  return is_radius && other_ways.empty() ? report::WidenedMisfit(of, a.fit.chi) : report::Misfit{of, a.fit.chi};
}

}  // namespace

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& all_readings, Estimator estimator) {
  std::vector<Reading> readings = WithAngles(all_readings);
  const std::vector<separate::FarOnCourse> far = TakeOutFar(readings);
  const CircleAnalysis a = Analyse(scenario, readings, estimator);
  report::Evaluation evaluation;
  evaluation.separation = SeparationJson(a);
  evaluation.results = {{"readings", a.points.size()},
                        {"left_out", all_readings.size() - a.points.size()},
                        {"estimator", EstimatorName(estimator)},
                        {"setups", evaluation.separation["setups"]},
                        {"errors", evaluation.separation["errors"]},
                        {"iso230_4", evaluation.separation["iso230_4"]}};
  if (!a.lag_kind.empty()) evaluation.results["lag_kind"] = a.lag_kind;
  if (evaluation.separation.contains("comparison")) evaluation.results["comparison"] = evaluation.separation["comparison"];
  for (const CirclePath& path : a.paths) evaluation.results["radial"].push_back(RadialJson(path, a.fit.shared));
  for (const RadialPart& part : RadialPartsOf(a)) evaluation.results["radial_parts"].push_back({{"errors", part.keys}, {"rms_um", In(um, part.rms_m)}});
  const std::vector<RankedError> ranked = RankedErrors(a);
  if (!ranked.empty()) evaluation.results["ranked"] = RankedJson(ranked);
  if (!far.empty()) evaluation.results["far"] = report::FarJson(far, "off_um", um);
  evaluation.summary = fmt::format("{} of {} readings have a radius\n", a.points.size() + far.size(), all_readings.size()) +
                       report::FarText(far, "the radius of reading {} ({:.6g} deg)", "µm", um);
  if (!a.method_bias.empty()) evaluation.results["method_bias"] = BiasJson(a.method_bias);
  evaluation.summary += BiasText(a);
  evaluation.summary += RankedText(ranked) + DeviationsText(a);
  const ShapesAsRead shapes = ShapesOf(a, CircularOf(scenario).machine);
  if (!shapes.values.empty()) evaluation.results["as_read"] = shapes.values;
  if (a.IsFitted()) evaluation.summary += ErrorsText(a) + shapes.text;
  evaluation.tables = {{"polar.txt", PolarsOf(a)}};
  if (a.IsFitted() && a.fit.dof > 0) evaluation.misfits = {MisfitOf(a, OtherWays(readings))};
  if (a.IsFitted()) evaluation.joints = [fit = a.fit] { return std::vector<uncertainty::Joint>{JointOf(fit)}; };
  evaluation.score = [a](const json& truth) { return ScoreOf(a, truth); };
  return evaluation;
}

}  // namespace twinbench::benches::circular
