#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/analysis.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/core/errors.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;
using nlohmann::json;

/// Estimated minus true path, all passes together.
struct PathScore {
  int readings = 0, values = 0;
  double sum_m2 = 0.0, largest_m = 0.0, sum_normed = 0.0;

  double Rms_m() const { return std::sqrt(sum_m2 / values); }
};

/// One number of a point of a path.
struct PathValue {
  const char* key;
  double value_m, u_m, truth_m;
};

/// Along x and y, or along the radius where that is all that was read.
std::vector<PathValue> ValuesOf(const CirclePath& path, std::size_t i, const json& truth, const SharedUncertainty& shared) {
  const PathPoint& point = path.points[i];
  PathPoint actual = point;
  actual.d_m = units::um * Eigen::Vector2d(truth.at("dx_um")[i].get<double>(), truth.at("dy_um")[i].get<double>());
  if (!path.has_angle) return {{"radial_um", point.Radial_m(), RadialUncertainty_m(point, shared), actual.Radial_m()}};
  const Eigen::Vector2d u_m = Uncertainty_m(point, shared);
  return {{"dx_um", point.d_m.x(), u_m.x(), actual.d_m.x()}, {"dy_um", point.d_m.y(), u_m.y(), actual.d_m.y()}};
}

/// Some of the points of a pass, one by one.
void AddValues(std::size_t pass, const CirclePath& path, const json& truth, const SharedUncertainty& shared,
               report::ScoredRun& scored) {
  constexpr std::size_t kPoints = 12;
  if (truth.at("dx_um").size() != path.points.size()) return;
  const std::size_t every = std::max<std::size_t>(1, path.points.size() / kPoints);
  for (std::size_t i = 0; i < path.points.size(); i += every) {
    for (const PathValue& v : ValuesOf(path, i, truth, shared))
      scored.values.push_back({fmt::format("path[{}].{}[{}]", pass, v.key, i), v.value_m / units::um, v.u_m / units::um, v.truth_m / units::um});
  }
}

void AddPass(const CirclePath& path, const json& truth, const SharedUncertainty& shared, PathScore& score) {
  if (truth.at("dx_um").size() != path.points.size()) return;  // readings that are missing shift the rest
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    ++score.readings;
    for (const PathValue& v : ValuesOf(path, i, truth, shared)) {
      const double error_m = v.value_m - v.truth_m;
      ++score.values;
      score.sum_m2 += error_m * error_m;
      score.largest_m = std::max(score.largest_m, std::abs(error_m));
      score.sum_normed += std::pow(error_m / v.u_m, 2);
    }
  }
}

PathScore ScorePaths(const CircleAnalysis& a, const json& truth, report::ScoredRun& scored) {
  PathScore score;
  for (std::size_t k = 0; k < a.paths.size(); ++k) {
    const CirclePath& path = a.paths[k];
    const auto same = [&](const json& t) { return t.at("setup") == path.setup && t.at("pass") == path.pass; };
    const auto found = std::ranges::find_if(truth.at("path"), same);
    if (found == truth.at("path").end()) continue;
    AddPass(path, *found, a.fit.shared, score);
    AddValues(k, path, *found, a.fit.shared, scored);
  }
  return score;
}

/// Sizes that the run shows, against those of the scenario; phases are left out, they mean little where there is no
/// size. Value by value, waves are compared by their parts.
/// @param nearly  Keys whose truth holds no uncertainty: of bodies, which lose and lag at each feed otherwise.
json ErrorScores(const CircleFit& fit, const json& truth, const json& nearly, report::ScoredRun& scored) {
  json scores = json::object();
  const std::vector<WavePart> parts = WavePartsOf(fit);
  const auto is_wave = [&](const std::string& key) {
    return std::ranges::find(parts, key, &WavePart::amplitude) != parts.end();
  };
  for (const WavePart& p : parts) {
    if (!truth.contains(p.amplitude) || !truth.contains(p.azimuth)) continue;
    const double actual = p.Of(truth.at(p.amplitude).get<double>(), truth.at(p.azimuth).get<double>());
    scored.values.push_back({p.part.key, p.part.value, p.part.u, actual});
  }
  scored.text += fmt::format("{:<34} {:>14}   {}\n", "error of", "estimate-truth", "stated u");
  for (const ErrorValue& e : ErrorsOf(fit)) {
    if (!truth.contains(e.key) || !std::isfinite(e.u) || e.unit == "deg") continue;
    const double actual = truth.at(e.key).get<double>(), error = e.value - actual;
    const bool is_near = std::count(nearly.begin(), nearly.end(), e.key) > 0;
    if (!is_wave(e.key) && !is_near) scored.values.push_back({e.key, e.value, e.u, actual});
    scores[e.key] = {{"error", error}, {"u", e.u}, {"unit", e.unit}};
    if (is_near) scores[e.key]["of_bodies"] = true;
    scored.text += fmt::format("{:<34} {:+14.4g}   u {:.2g} {}{}\n", e.key, error, e.u, e.unit,
                               is_near ? "   (of bodies: it depends on the feed)" : "");
  }
  return scores;
}

}  // namespace

report::ScoredRun ScoreOf(const CircleAnalysis& a, const json& truth) {
  report::ScoredRun scored;
  const PathScore path = ScorePaths(a, truth, scored);
  if (path.readings == 0) throw InputError("the run", "none of its passes is in the truth", "a run of the twin");
  scored.json["path"] = {{"readings", path.readings},
                         {"rms_error_um", path.Rms_m() / units::um},
                         {"largest_error_um", path.largest_m / units::um},
                         {"mean_normed_square", report::In(1.0, path.sum_normed / path.values)}};
  scored.text = fmt::format("path: off the truth by {:.4f} um rms, {:.4f} um at most\n", path.Rms_m() / units::um,
                            path.largest_m / units::um);
  if (a.IsFitted()) scored.json["errors"] = ErrorScores(a.fit, truth.at("errors"), truth.value("nearly", json::array()), scored);
  return scored;
}

report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings, const json& truth,
                           Estimator estimator) {
  return ScoreOf(Analyse(scenario, readings, estimator), truth);
}

}  // namespace twinbench::benches::circular
