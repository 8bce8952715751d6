#include "twin/report/page/tables.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/page/causes.h"
#include "twin/report/page/circles.h"
#include "twin/report/page/curves.h"
#include "twin/report/page/diagnosis_page.h"
#include "twin/report/page/named_numbers.h"
#include "twin/report/page/walk.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

/// A point of a curve, and how far it is from zero.
struct Largest {
  const FigureSeries* series = nullptr;
  std::size_t at = 0;
  double size = -1.0;
};

/// Of all directions or mountings that the figure shows.
Largest LargestPointOf(const Figure& figure) {
  Largest largest;
  for (const FigureSeries& series : figure.series) {
    if (series.role != SeriesRole::kEstimate) continue;
    for (std::size_t k = 0; k < series.y.size(); ++k)
      if (std::abs(series.y[k]) > largest.size) largest = {&series, k, std::abs(series.y[k])};
  }
  return largest;
}

double RmsOf(const std::vector<double>& values) {
  double squares = 0.0, counted = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) squares += value * value, ++counted;
  return std::sqrt(squares / counted);
}

void AddCurve(const std::vector<Figure>& curves, std::vector<PageTile>& tiles) {
  if (curves.empty()) return;
  const Figure& figure = curves.front();
  const Largest largest = LargestPointOf(figure);
  if (!largest.series) return;
  const FigureSeries& curve = *largest.series;
  const std::string of = figure.title + (curve.name == "estimate" ? "" : ", " + curve.name);
  const double U = curve.u.empty() ? std::nan("") : curve.k * curve.u[largest.at];
  tiles.push_back({"Largest error", MeasuredText(curve.y[largest.at], U, figure.y.unit), fmt::format("{}, at {:.6g}°", of, curve.x[largest.at])});
  tiles.push_back({"Rms error", NumberText(RmsOf(curve.y), U) + AfterNumber(ShownUnit(figure.y.unit)), of});
}

/// Of a map of errors by place: the largest component.
void AddLargestInSpace(const json& results, std::vector<PageTile>& tiles) {
  PageTile tile;
  double size = -1.0;
  ForEachObject(results, [&](const std::string& path, const json& map) {
    const auto x = NumbersAt(map, "x_mm"), y = NumbersAt(map, "y_mm"), z = NumbersAt(map, "z_mm");
    if (!x || !y || !z) return;
    for (const auto& [key, value] : map.items()) {
      const auto error = NumbersOf(value), u = NumbersAt(map, "u_" + key);
      if (!error || !u || u->size() != error->size() || x->size() != error->size()) continue;
      for (std::size_t k = 0; k < error->size(); ++k) {
        if (!(std::abs((*error)[k]) > size)) continue;
        size = std::abs((*error)[k]);
        const auto [name, unit] = NameAndUnit(key);
        tile = {"Largest error", MeasuredText((*error)[k], CoverageOf(results, path + "." + key) * (*u)[k], unit),
                fmt::format("{}: {}, at x {:.0f}, y {:.0f}, z {:.0f} mm", CurveTitle(path, ""), name, (*x)[k], (*y)[k], (*z)[k])};
      }
    }
  });
  if (size >= 0.0) tiles.push_back(tile);
}

/// The circular deviation of both directions together (ISO 230-4), the largest of all circles.
void AddCircularDeviation(const json& results, std::vector<PageTile>& tiles) {
  const json* largest = nullptr;
  const json circles = ListAt(results, "iso230_4");
  for (const json& circle : circles)
    if (std::isfinite(NumberAt(circle, "G_b_um")) && (!largest || NumberAt(circle, "G_b_um") > NumberAt(*largest, "G_b_um"))) largest = &circle;
  if (!largest) return;
  const double U_um = CoverageOf(results, "iso230_4.G_b_um") * NumberAt(*largest, "u_G_b_um");
  tiles.push_back({"Circular deviation G(b)", MeasuredText(NumberAt(*largest, "G_b_um"), U_um, "um"), "ISO 230-4, " + CircleInWords(*largest)});
}

void AddScore(const json& score, std::vector<PageTile>& tiles) {
  constexpr double kTooLarge = 4.0;  // twice its u, in the mean over the places
  double worst = -1.0;
  std::string of;
  ForEachObject(score, [&](const std::string& path, const json& object) {
    for (const char* key : {"mean_chi2", "mean_normed_square", "chi2_over_rank"})
      if (const double mean = NumberAt(object, key); std::isfinite(mean) && mean > worst) worst = mean, of = path;
  });
  if (worst < 0.0) return;
  tiles.push_back({"Worst (error/u)²", fmt::format("{:.2f}", worst), (of.empty() ? "" : CurveTitle(of, "") + "; ") + "1 is expected",
                   worst > kTooLarge ? VerdictTone::kBad : VerdictTone::kGood});
}

void AddDiagnosis(const json& results, std::vector<PageTile>& tiles) {
  if (!results.contains("diagnosis")) return;
  const json& diagnosis = results.at("diagnosis");
  const std::string verdict = TextAt(diagnosis, "verdict");
  const VerdictTone tone = VerdictOf(diagnosis).tone;
  if (verdict == "none") return tiles.push_back({"Diagnosis", "consistent", "with the scenario", tone});
  if (verdict == "unknown") return tiles.push_back({"Diagnosis", "unmodelled effect", TextAt(diagnosis.value("unknown", json()), "signature"), tone});
  const std::vector<CauseGroup> groups = GroupsOf(diagnosis);
  if (groups.empty()) return;
  tiles.push_back({"Diagnosis", groups.front().name, groups.size() == 1 ? groups.front().size : groups.front().size + fmt::format("; and {} more", groups.size() - 1), tone});
}

void AddLost(const json& results, std::vector<PageTile>& tiles) {
  const PageTable lost = NotSeparableTable(results);
  if (lost.rows.empty()) return;
  tiles.push_back({"Not separable", fmt::format("{}", lost.rows.size()), lost.rows.front()[0] + (lost.rows.size() > 1 ? ", ..." : ""), VerdictTone::kDoubt});
}

}  // namespace

std::vector<PageTile> TilesOf(const json& results, const json& score, const std::vector<Figure>& curves) {
  std::vector<PageTile> tiles;
  AddCurve(curves, tiles);
  if (tiles.empty()) AddLargestInSpace(results, tiles);
  AddCircularDeviation(results, tiles);
  AddScore(score, tiles);
  AddDiagnosis(results, tiles);
  AddLost(results, tiles);
  return tiles;
}

}  // namespace twinbench::report
