#include "twin/report/page/residual_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/page/named_numbers.h"
#include "twin/report/sound.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

struct Chosen {
  Figure figure;
  std::vector<std::string> answers;
  double explained = 0.0;  // by the extension
  double loudness = 0.0;   // mean of (residual / u)^2, where there is no extension
};

std::string UnitOf(const json& plots, const std::string& channel) {
  if (plots.contains("units") && plots.at("units").contains(channel)) return InPrint(TextAt(plots.at("units"), channel));
  return InPrint(TextAt(plots, "unit"));
}

double SquaresOf(const std::vector<double>& values, const std::vector<double>& u) {
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double scaled = u.empty() ? values[k] : values[k] / u[k];
    if (std::isfinite(scaled)) sum += scaled * scaled;
  }
  return sum;
}

/// How much of the residual the extension explains, as the logarithm of a likelihood ratio: with the stated uncertainty of each
/// point, or, where there is none, with what is left after it.
double ExplainedIn(const std::vector<double>& before, const std::vector<double>& after, const std::vector<double>& u) {
  if (!u.empty()) return 0.5 * (SquaresOf(before, u) - SquaresOf(after, u));
  const double ratio = SquaresOf(before, {}) / SquaresOf(after, {});
  return ratio > 0.0 && std::isfinite(ratio) ? 0.5 * static_cast<double>(before.size()) * std::log(ratio) : 0.0;
}

/// Against a room that kept its temperature there is nothing to be seen.
bool Changes(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low > 1e-9 * std::max(std::abs(*low), std::abs(*high));
}

/// Bits alike, gaps too.
bool AreAlike(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

/// One curve where nothing was extended, else both and what is between them.
std::vector<FigureSeries> BeforeAndAfter(const std::vector<double>& x, const std::vector<double>& before, const std::vector<double>& after,
                                         const std::vector<double>& u) {
  if (AreAlike(before, after)) return {{"residual", SeriesRole::kEstimate, x, before, u}};
  std::vector<double> causes;
  for (std::size_t k = 0; k < before.size(); ++k) causes.push_back(before[k] - after[k]);
  return {{"before", SeriesRole::kBefore, x, before, u}, {"after", SeriesRole::kAfter, x, after, u}, {"identified causes", SeriesRole::kExpected, x, causes, {}}};
}

void AddAgainst(const json& plots, std::vector<Chosen>& chosen) {
  const json against = plots.value("against", json::object());
  for (const auto& [circumstance, channels] : against.items()) {
    for (const auto& [channel, curve] : channels.items()) {
      const auto x = NumbersAt(curve, "x"), before = NumbersAt(curve, "before"), after = NumbersAt(curve, "after");
      if (!x || !before || !after || x->size() < 2 || !Changes(*x)) continue;
      const std::vector<double> u = NumbersAt(curve, "u").value_or(std::vector<double>());
      const auto [name, unit] = NameAndUnit(circumstance);
      Figure figure{FigureForm::kLine, "Residual of " + NameAndUnit(channel).name + " against " + name, "means with their uncertainty",
                    {name, unit}, {channel, UnitOf(plots, channel)},
                    BeforeAndAfter(*x, *before, *after, u)};
      chosen.push_back({figure, {name, channel}, ExplainedIn(*before, *after, u),
                        u.empty() ? 0.0 : SquaresOf(*before, u) / static_cast<double>(before->size())});
    }
  }
}

/// A value for each position and set-up.
void AddMaps(const json& plots, std::vector<Chosen>& chosen) {
  const json maps = plots.value("maps", json::object());
  for (const auto& [channel, map] : maps.items()) {
    const auto position = NumbersAt(map, "position"), setup = NumbersAt(map, "setup");
    if (!position || !setup || position->size() < 2) continue;
    for (std::size_t s = 0; s < setup->size(); ++s) {
      const auto before = NumbersOf(map.at("before").at(s)), after = NumbersOf(map.at("after").at(s));
      if (!before || !after || before->size() != position->size()) continue;
      const std::string where = fmt::format("position in mounting {:g}", (*setup)[s]);
      Figure figure{FigureForm::kLine, "Residual of " + NameAndUnit(channel).name + " against " + where, "", {"position", ""},
                    {channel, UnitOf(plots, channel)},
                    BeforeAndAfter(*position, *before, *after, {})};
      chosen.push_back({figure, {where, channel}, ExplainedIn(*before, *after, {}), 0.0});
    }
  }
}

}  // namespace

PageChoice ResidualChoice(const json& plots) {
  std::vector<Chosen> chosen;
  AddAgainst(plots, chosen);
  AddMaps(plots, chosen);
  const auto tells_less = [](const Chosen& a, const Chosen& b) {
    return std::pair(a.explained, a.loudness) < std::pair(b.explained, b.loudness);
  };
  const auto loudest = std::max_element(chosen.begin(), chosen.end(), tells_less);
  if (loudest != chosen.end()) std::rotate(chosen.begin(), loudest, loudest + 1);
  const bool is_extended = std::any_of(chosen.begin(), chosen.end(), [](const Chosen& c) { return c.figure.series.size() > 1; });
  PageChoice choice{is_extended ? "Residuals before and after the extension" : "Residuals", "", {"against", "of"}, {}, {}};
  for (Chosen& one : chosen) {
    choice.answers.push_back(one.answers);
    choice.figures.push_back(std::move(one.figure));
  }
  return choice;
}

}  // namespace twinbench::report
