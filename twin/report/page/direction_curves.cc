#include "twin/report/page/curves.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "twin/core/units.h"
#include "twin/report/page/named_numbers.h"
#include "twin/report/page/walk.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

/// The difference forward less backward by position, and its u.
struct Reversal {
  std::vector<double> x, difference, u;
  std::string unit;
};

Reversal ReversalOf(const json& results) {
  const json lists = results.is_object() ? results.value("reversal", json()) : json();
  if (!lists.is_object()) return {};
  for (const auto& [key, value] : lists.items()) {
    const auto x = NumbersAt(lists, "position_deg"), difference = NumbersAt(lists, key), u = NumbersAt(lists, "u_" + key);
    if (key.starts_with("reversal_") && x && difference && u) return {*x, *difference, *u, NameAndUnit(key).unit};
  }
  return {};
}

/// @param sign  +1 forward, -1 backward. A direction's u is that of the mean and of half the difference: with as many readings
///              either way both are independent.
FigureSeries DirectionOf(const FigureSeries& mean, const Reversal& reversal, double sign) {
  FigureSeries series = mean;
  series.name = sign > 0.0 ? "forward" : "backward";
  series.u_order.clear();
  for (std::size_t k = 0; k < mean.y.size(); ++k) {
    series.y[k] += sign * 0.5 * reversal.difference[k];
    if (!mean.u.empty()) series.u[k] = std::hypot(mean.u[k], 0.5 * reversal.u[k]);
  }
  return series;
}

/// Sum of amplitude cos(order angle + phase).
struct Waves {
  std::vector<double> order, amplitude, phase_deg, u_amplitude;
};

/// The error of its waves in one direction, or of both. An order is as uncertain at every angle: its cosine and its sine are known
/// equally well.
FigureSeries SummedOf(const Waves& waves, double direction) {
  constexpr int kPoints = 720;  // several for the highest order that a bench gives
  FigureSeries series{direction > 0.0 ? "forward" : direction < 0.0 ? "backward" : "estimate", SeriesRole::kEstimate, {}, {}, {}};
  series.y.assign(kPoints, 0.0);
  double variance = 0.0;
  for (int i = 0; i < kPoints; ++i) series.x.push_back(i * 360.0 / kPoints);
  for (std::size_t k = 0; k < waves.order.size(); ++k) {
    if (!std::isfinite(waves.amplitude[k])) continue;  // not separable
    variance += waves.u_amplitude[k] * waves.u_amplitude[k];
    for (std::size_t i = 0; i < series.x.size(); ++i)
      series.y[i] += waves.amplitude[k] * std::cos((waves.order[k] * series.x[i] + waves.phase_deg[k]) * units::deg);
  }
  series.u.assign(kPoints, std::sqrt(variance));
  return series;
}

void AddSummed(const std::string& path, const json& object, const std::string& key, std::vector<Figure>& figures) {
  const auto at = [&object](const std::string& name) { return NumbersAt(object, name).value_or(std::vector<double>()); };
  const Waves waves{at("order"), at(key), at("phase_deg"), at("u_" + key)};
  for (const auto* list : {&waves.amplitude, &waves.phase_deg, &waves.u_amplitude})
    if (list->empty() || list->size() != waves.order.size()) return;
  const std::string title = CurveTitle(path, "error");
  if (figures.empty() || figures.back().title != title)
    figures.push_back({FigureForm::kAngle, title, "sum of its orders", {"angle", "deg"}, {"error", NameAndUnit(key).unit}, {}, {}, PathInWords(path) + ", error"});
  figures.back().series.push_back(SummedOf(waves, NumberAt(object, "direction")));
}

}  // namespace

void ShowDirections(const json& results, std::vector<Figure>& curves) {
  const Reversal reversal = ReversalOf(results);
  for (Figure& curve : curves) {
    FigureSeries& mean = curve.series.front();
    if (!curve.file.starts_with("device") || curve.y.unit != reversal.unit || mean.x != reversal.x) continue;
    const FigureSeries forward = DirectionOf(mean, reversal, 1.0), backward = DirectionOf(mean, reversal, -1.0);
    mean.name = "mean of both directions";
    if (curve.series.size() == 1) curve.series.clear();
    curve.series.insert(curve.series.end(), {forward, backward});
  }
}

std::vector<Figure> SummedCurves(const json& results) {
  std::vector<Figure> figures;
  ForEachObject(results, [&](const std::string& path, const json& object) {
    if (!path.starts_with("separation.") || !object.contains("order")) return;
    for (const auto& [key, value] : object.items())
      if (key.starts_with("amplitude_")) AddSummed(path, object, key, figures);
  });
  // What is under test before what it was measured by.
  std::ranges::stable_sort(figures, {}, [](const Figure& figure) { return figure.file.find("encoder") != std::string::npos; });
  return figures;
}

}  // namespace twinbench::report
