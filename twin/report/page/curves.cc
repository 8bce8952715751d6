#include "twin/report/page/curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "twin/report/page/named_numbers.h"
#include "twin/report/page/scored.h"
#include "twin/report/page/walk.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

constexpr std::array kAngles = {"position_deg", "commanded_deg"};
constexpr std::size_t kLeastPoints = 3;

bool IsUncertainty(const std::string& key) {
  return key.starts_with("u_");
}

/// What tells one of several objects of a list from the others: "mounting 1, head 12°".
std::string SeriesOf(const json& object) {
  std::string words;
  for (const std::string key : {"setup", "direction", "head_deg"}) {
    if (!std::isfinite(NumberAt(object, key))) continue;
    const auto [name, unit] = NameAndUnit(key);
    words += (words.empty() ? "" : ", ") + (key == "setup" ? "mounting" : name) + " " + MeasuredText(NumberAt(object, key), std::nan(""), unit);
  }
  return words;
}

/// The figure with that title and unit, made if there is none.
Figure& FigureFor(std::vector<Figure>& figures, const Figure& wanted) {
  for (Figure& figure : figures) {
    if (figure.title == wanted.title && figure.y.unit == wanted.y.unit) return figure;
  }
  figures.push_back(wanted);
  return figures.back();
}

void AddTruth(const json& score, const std::string& path, const std::vector<double>& x, const std::string& of,
              std::vector<FigureSeries>& series) {
  std::vector<double> truth = TruthOf(score, path, x.size());
  if (!truth.empty()) series.push_back({of.empty() ? "truth" : "truth, " + of, SeriesRole::kTruth, x, truth, {}});
}

/// A list of objects is "model.terms[]" in the budget.
bool IsNameOf(std::string name, const std::string& path) {
  if (const std::size_t at = name.find("[]"); at != std::string::npos) name.erase(at, 2);
  return name == path;
}

/// All lists of one object that go with its list `by`.
struct Lists {
  const json& results;  // the whole file
  const json& score;
  std::string path, by;
  FigureForm form;
  FigureAxis x;
};

void AddList(const Lists& lists, const json& object, const std::string& key, const std::vector<double>& x,
             std::vector<Figure>& figures) {
  const auto y = NumbersAt(object, key);
  if (!y || y->size() != x.size()) return;
  const std::string path = lists.path + "." + key;
  const auto [name, unit] = NameAndUnit(key);
  const std::string of = SeriesOf(object);
  Figure figure{lists.form, CurveTitle(lists.path, name), "", lists.x, {name, unit}, {}, {}, PathInWords(lists.path) + ", " + name};
  FigureSeries series{of.empty() ? "estimate" : of, SeriesRole::kEstimate, x, *y, {}, CoverageOf(lists.results, path)};
  if (const auto u = NumbersAt(object, "u_" + key); u && u->size() == x.size()) series.u = *u;
  if (object.contains("u_harmonics")) series.u_order = NumbersAt(object.at("u_harmonics"), key).value_or(std::vector<double>());
  Figure& to = FigureFor(figures, figure);
  to.series.push_back(series);
  AddTruth(lists.score, path, x, of, to.series);
}

std::optional<std::string> AngleOf(const json& object) {
  for (const char* angle : kAngles) {
    if (const auto x = NumbersAt(object, angle); x && x->size() >= kLeastPoints) return angle;
  }
  return {};
}

bool IsCounter(const std::string& key) {
  return key == "readings" || key == "face" || key == "lines";
}

/// What a reader looks for first: what was under test before what it was compared with, and the turn about its own axis
/// before its other errors.
int RankOf(const Figure& figure) {
  const bool of_reference = figure.file.starts_with("reference") || figure.file.starts_with("multitooth");
  return 2 * (of_reference ? 1 : 0) + (figure.y.name == "ez" ? 0 : 1);
}

void Rank(std::vector<Figure>& figures) {
  std::ranges::stable_sort(figures, {}, RankOf);
}

// Spectra ------------------------------------------------------------------------------------------------------------

bool IsAmplitude(const std::string& key) {
  constexpr std::array kOthers = {"phase", "order", "cosine", "sine"};
  return !IsUncertainty(key) && std::ranges::none_of(kOthers, [&key](const char* other) { return key.starts_with(other); });
}

/// [{ "order": 1, "amplitude_arcsec": 6.1, ...}, ...] as lists beside each other.
json ListsOf(const json& terms) {
  json lists = json::object();
  for (const json& term : terms) {
    if (!term.is_object() || !term.contains("order") || !term.at("order").is_number()) return {};
    for (const auto& [key, value] : term.items()) {
      if (value.is_number() || value.is_null()) lists[key].push_back(value);
    }
  }
  return lists;
}

void AddSpectrum(const Lists& lists, const json& object, std::vector<Figure>& figures) {
  const auto orders = NumbersAt(object, "order");
  if (!orders || orders->size() < 2 || lists.path.ends_with("u_harmonics")) return;  // those are the limits of the spectrum of their curve
  for (const auto& [key, value] : object.items())
    if (IsAmplitude(key)) AddList(lists, object, key, *orders, figures);
}

/// Lists of terms, which are objects of their own.
void AddTerms(const json& results, const json& score, const std::string& path, const json& object,
              std::vector<Figure>& figures) {
  for (const auto& [key, value] : object.items()) {
    if (!value.is_array() || value.empty() || !value.front().is_object()) continue;
    const json lists = ListsOf(value);
    const std::string inside = path.empty() ? key : path + "." + key;
    if (lists.is_object())
      AddSpectrum({results, score, inside, "order", FigureForm::kBars, {"order", ""}}, lists, figures);
  }
}

}  // namespace

double CoverageOf(const json& results, const std::string& path) {
  if (!results.is_object() || !results.contains("uncertainty_budget")) return 2.0;
  for (const json& budget : results.at("uncertainty_budget")) {
    if (IsNameOf(budget.value("name", ""), path) && budget.contains("k") && budget.at("k").is_number())
      return budget.at("k").get<double>();
  }
  return 2.0;
}

std::vector<Figure> CurveFigures(const json& results, const json& score) {
  std::vector<Figure> figures;
  ForEachObject(results, [&](const std::string& path, const json& object) {
    const auto angle = AngleOf(object);
    if (!angle || object.contains("pass")) return;
    const Lists lists{results, score, path, *angle, FigureForm::kAngle, {NameAndUnit(*angle).name, "deg"}};
    for (const auto& [key, value] : object.items()) {
      if (key != *angle && !IsUncertainty(key) && !IsCounter(key))
        AddList(lists, object, key, *NumbersAt(object, *angle), figures);
    }
  });
  Rank(figures);
  return figures;
}

std::vector<Figure> DeviationFigures(const std::vector<Figure>& curves) {
  std::vector<Figure> figures;
  for (const Figure& curve : curves) {
    Figure figure{FigureForm::kLine, "Estimate less truth: " + curve.title, "", curve.x, curve.y, {}, {}, curve.file + ", less truth"};
    for (std::size_t k = 0; k + 1 < curve.series.size(); ++k) {
      const FigureSeries &estimate = curve.series[k], &truth = curve.series[k + 1];
      if (estimate.role != SeriesRole::kEstimate || truth.role != SeriesRole::kTruth) continue;
      FigureSeries less = estimate;
      less.name = curve.series.size() > 2 ? estimate.name : "estimate less truth";
      for (std::size_t i = 0; i < less.y.size(); ++i) less.y[i] -= truth.y[i];
      figure.series.push_back(std::move(less));
    }
    if (!figure.series.empty()) figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<Figure> SpectrumFigures(const json& results, const json& score) {
  std::vector<Figure> figures;
  ForEachObject(results, [&](const std::string& path, const json& object) {
    AddSpectrum({results, score, path, "order", FigureForm::kBars, {"order", ""}}, object, figures);
    AddTerms(results, score, path, object, figures);
  });
  for (Figure& figure : figures) AddNoiseLimit(figure);
  return figures;
}

}  // namespace twinbench::report
