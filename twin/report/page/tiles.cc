#include "twin/report/page/tiles.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/page/causes.h"
#include "twin/report/page/diagnosis_page.h"
#include "twin/report/page/named_numbers.h"
#include "twin/report/page/tables.h"
#include "twin/report/page/walk.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

const FigureSeries* FirstEstimate(const std::vector<Figure>& curves) {
  if (curves.empty()) return nullptr;
  for (const FigureSeries& series : curves.front().series)
    if (series.role == SeriesRole::kEstimate) return &series;
  return nullptr;
}

void AddCurve(const std::vector<Figure>& curves, std::vector<PageTile>& tiles) {
  const FigureSeries* curve = FirstEstimate(curves);
  if (!curve) return;
  const Figure& figure = curves.front();
  std::size_t largest = curve->y.size();
  double squares = 0.0;
  int counted = 0;
  for (std::size_t k = 0; k < curve->y.size(); ++k) {
    if (!std::isfinite(curve->y[k])) continue;
    if (largest == curve->y.size() || std::abs(curve->y[k]) > std::abs(curve->y[largest])) largest = k;
    squares += curve->y[k] * curve->y[k];
    ++counted;
  }
  if (counted == 0) return;
  const double U = curve->u.empty() ? std::nan("") : curve->k * curve->u[largest], rms = std::sqrt(squares / counted);
  tiles.push_back({"Largest error", MeasuredText(curve->y[largest], U, figure.y.unit),
                   fmt::format("{}, at {:.6g}°", figure.title, curve->x[largest])});
  tiles.push_back({"Rms error", NumberText(rms, U) + AfterNumber(ShownUnit(figure.y.unit)), figure.title});
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
  AddScore(score, tiles);
  AddDiagnosis(results, tiles);
  AddLost(results, tiles);
  return tiles;
}

}  // namespace twinbench::report
