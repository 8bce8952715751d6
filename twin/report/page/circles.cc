#include "twin/report/page/circles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "twin/report/page/causes.h"
#include "twin/report/page/curves.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

std::string FeedOf(const json& pass) {
  const double feed_mm_min = NumberAt(pass, "feed_mm_min");
  return feed_mm_min > 0.0 ? NumberText(feed_mm_min) + " mm/min" : "at rest";
}

/// "0 (bar)".
std::string SetupOf(const json& pass) {
  return fmt::format("{:g} ({})", NumberAt(pass, "setup"), TextAt(pass, "instrument"));
}

/// Once round from 0° on, whichever way the pass went.
FigureSeries SeriesOfPass(const json& pass) {
  FigureSeries series{NumberAt(pass, "direction") < 0.0 ? "clockwise" : "counter-clockwise", SeriesRole::kEstimate, {}, {}, {}};
  const std::vector<double> angle_deg = NumbersAt(pass, "commanded_deg").value_or(std::vector<double>());
  const std::vector<double> radial_um = NumbersAt(pass, "radial_um").value_or(std::vector<double>());
  if (angle_deg.size() != radial_um.size()) return series;
  std::vector<std::pair<double, double>> points;
  for (std::size_t k = 0; k < angle_deg.size(); ++k) {
    constexpr double kWritten_deg = 1e-6;  // 359.9999999 is 0
    const double turned_deg = angle_deg[k] - 360.0 * std::floor(angle_deg[k] / 360.0 + kWritten_deg);
    points.emplace_back(std::max(turned_deg, 0.0), radial_um[k]);
  }
  std::ranges::stable_sort(points, {}, &std::pair<double, double>::first);
  for (const auto& [x, y] : points) series.x.push_back(x), series.y.push_back(y);
  if (const double u_um = NumberAt(pass, "u_radial_um"); std::isfinite(u_um)) series.u.assign(points.size(), u_um);
  return series;
}

double LargestOf(const Figure& figure) {
  double largest = 0.0;
  for (const FigureSeries& series : figure.series)
    for (const double y : series.y) largest = std::isfinite(y) ? std::max(largest, std::abs(y)) : largest;
  return largest;
}

struct RankedErrors {
  std::string names, sizes;  // of both axes
  double rms_um, share;
};

/// "x 0.10 ± 0.34 µm/m"; nothing of what the run does not show.
std::string SizeOf(const json& results, const std::string& key, const std::string& of) {
  const json error = results.value("errors", json::object()).value(key, json::object());
  const double U = CoverageOf(results, "errors." + key) * NumberAt(error, "u");
  return std::isfinite(U) ? of + MeasuredText(NumberAt(error, "value"), U, TextAt(error, "unit")) : "";
}

/// "machine lag x" and "machine lag y" are "machine lag x and y".
RankedErrors RankedOf(const json& results, const json& part) {
  RankedErrors ranked{"", "", NumberAt(part, "rms_um"), 0.0};
  const json keys = ListAt(part, "errors");
  for (const json& key : keys) {
    const std::string name = PathInWords(NameAndUnit(key.get<std::string>()).name), axis = name.substr(name.rfind(' ') + 1);
    const std::string size = SizeOf(results, key.get<std::string>(), keys.size() > 1 ? axis + " " : "");
    ranked.names += ranked.names.empty() ? name : " and " + axis;
    ranked.sizes += (ranked.sizes.empty() || size.empty() ? "" : ", ") + size;
  }
  return ranked;
}

std::vector<RankedErrors> Ranked(const json& results) {
  std::vector<RankedErrors> ranked;
  double squares = 0.0;
  for (const json& part : ListAt(results, "radial_parts")) {
    ranked.push_back(RankedOf(results, part));
    if (ranked.back().sizes.empty()) ranked.pop_back();
    else squares += ranked.back().rms_um * ranked.back().rms_um;
  }
  for (RankedErrors& error : ranked) error.share = squares > 0.0 ? error.rms_um * error.rms_um / squares : 0.0;
  return ranked;
}

}  // namespace

std::string CircleInWords(const json& circle) {
  return fmt::format("mounting {}, {}", SetupOf(circle), FeedOf(circle));
}

PageChoice CircleChoice(const json& results) {
  PageChoice choice{"Circles", "", {"mounting", "feed"}, {}, {}};
  for (const json& pass : ListAt(results, "radial")) {
    const std::string setup = SetupOf(pass);
    const std::vector<std::string> answer = {setup, FeedOf(pass)};
    auto at = std::ranges::find(choice.answers, answer) - choice.answers.begin();
    if (at == std::ssize(choice.answers)) {
      const double radius_mm = NumberAt(pass, "radius_mm");
      Figure figure{FigureForm::kAngle, "Radial deviation, " + CircleInWords(pass), fmt::format("R = {:.6g} mm", radius_mm),
                    {"commanded angle", "deg"}, {"radial deviation", "um"}, {}};
      figure.radius = 1000.0 * radius_mm;
      choice.answers.push_back(answer);
      choice.figures.push_back(std::move(figure));
    }
    choice.figures[static_cast<std::size_t>(at)].series.push_back(SeriesOfPass(pass));
  }
  const auto largest = std::ranges::max_element(choice.figures, {}, LargestOf) - choice.figures.begin();
  std::rotate(choice.answers.begin(), choice.answers.begin() + largest, choice.answers.end());
  std::rotate(choice.figures.begin(), choice.figures.begin() + largest, choice.figures.end());
  return choice;
}

Figure ErrorRankFigure(const json& results) {
  constexpr double kWorthSeeing = 0.001;
  Figure figure{FigureForm::kShares, "Errors by their share of the radial deviation", "of the sum of the mean squares that each makes", {"", ""},
                {"share", ""}, {}};
  FigureSeries bars{"share", SeriesRole::kEstimate, {}, {}, {}};
  for (const RankedErrors& error : Ranked(results)) {
    if (error.share < kWorthSeeing) continue;
    figure.categories.push_back(error.names);
    bars.y.push_back(error.share);
  }
  if (!bars.y.empty()) figure.series.push_back(std::move(bars));
  return figure;
}

PageTable ErrorRankTable(const json& results) {
  PageTable table{"Errors, ranked", {"error", "size with U", "radial rms [µm]", "share"}, {}};
  for (const RankedErrors& error : Ranked(results))
    table.rows.push_back({error.names, error.sizes, fmt::format("{:.2g}", error.rms_um), Percent(error.share)});
  return table;
}

}  // namespace twinbench::report
