#include "twin/report/error_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/number_text.h"
#include "twin/core/reading.h"
#include "twin/report/curve_score.h"
#include "twin/uncertainty/quantities.h"

namespace twinbench::report {
namespace {

constexpr std::string_view kOfSeparation = "separation.";

/// "path[0].dx_um" as a pointer into its document.
nlohmann::json::json_pointer PointerTo(const std::string& name) {
  std::string path = "/";
  for (const char c : name) path += c == '.' || c == '[' ? std::string("/") : c == ']' ? std::string() : std::string(1, c);
  return nlohmann::json::json_pointer(path);
}

/// Where the numbers of a list were read.
struct Places {
  std::string of;  // "position_deg"
  nlohmann::json list;
};

Places PlacesOf(const nlohmann::json& document, const std::string& list) {
  constexpr std::array kKeys = {"position_deg", "commanded_deg", "angle_deg", "order", "orders"};
  const std::size_t dot = list.rfind('.');
  const nlohmann::json::json_pointer beside = dot == std::string::npos ? nlohmann::json::json_pointer() : PointerTo(list.substr(0, dot));
  if (!document.contains(beside)) return {};
  const nlohmann::json& table = document.at(beside);
  for (const char* key : kKeys)
    if (table.is_object() && table.contains(key) && table.at(key).is_array()) return {key, table.at(key)};
  return {};
}

std::string NumberText(double value) {
  return std::isfinite(value) ? PrintInUnit(value, 1.0) : "";
}

std::size_t PlaceIn(const std::string& name) {
  return name.ends_with(']') ? std::stoul(name.substr(name.rfind('[') + 1)) : std::size_t(-1);
}

/// @param before  Stands before the names.
void AddRows(const nlohmann::json& document, const std::string& before, std::set<std::string>& written, std::string& text) {
  for (const uncertainty::Quantity& q : uncertainty::StatedQuantities(document)) {
    const std::string name = q.name.starts_with(kOfSeparation) ? q.name.substr(kOfSeparation.size()) : q.name;
    if (!written.insert(name).second) continue;
    const Places places = PlacesOf(document, uncertainty::ListOf(q.name));
    const std::size_t at = PlaceIn(q.name);
    const bool is_placed = at < places.list.size() && places.list[at].is_number();
    text += fmt::format("{},{},{},{},{}\n", QuoteCsv(before + name), is_placed ? NumberText(places.list[at].get<double>()) : "", is_placed ? places.of : "",
                        NumberText(q.value), NumberText(q.u));
  }
}

/// A user's number.
struct Own {
  double value = kNaN, u = kNaN;
};

std::map<std::string, Own> OwnOf(const CsvTable& csv) {
  constexpr const char* kExpected = "result and value, and u if there is one, as `separate --tables` writes them";
  const std::size_t result = NeededColumn(csv, "result", kExpected), value = NeededColumn(csv, "value", kExpected);
  const auto u = csv.Column("u");
  std::map<std::string, Own> all;
  for (const CsvTable::Row& row : csv.rows) {
    Own own{row.fields[value].empty() ? kNaN : CsvNumber(csv, row, value, 1.0), kNaN};
    if (u && !row.fields[*u].empty()) own.u = CsvNumber(csv, row, *u, 1.0);
    if (own.u < 0.0) throw InputError(csv.Where(row), "u is " + row.fields[*u], "a standard uncertainty, zero or more");
    if (!all.emplace(row.fields[result], own).second)
      throw InputError(csv.Where(row), row.fields[result] + " comes twice", "every result once");
  }
  return all;
}

/// "target" and "ez_arcsec" of "target.ez_arcsec[3]".
CurveScore CurveNamed(const std::string& list, const std::string& whose) {
  const std::size_t dot = list.rfind('.');
  CurveScore curve;
  curve.name = whose + (dot == std::string::npos ? "" : list.substr(0, dot));
  curve.value = dot == std::string::npos ? list : list.substr(dot + 1);
  if (curve.value.find('_') == std::string::npos) curve.value += "_";
  return curve;
}

void AddPoint(double estimate, double u, const ScoredValue& v, CurveScore& curve) {
  curve.position.push_back(static_cast<double>(PlaceIn(v.name)));
  curve.estimate.push_back(estimate);
  curve.u.push_back(u);
  curve.truth.push_back(v.truth);
}

double MeanOfAll(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// "a, b, c and 7 more"
std::string FirstNames(const std::vector<std::string>& names) {
  constexpr std::size_t kTold = 3;
  const std::size_t told = std::min(kTold, names.size());
  const std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(told), ", "));
  return names.size() > told ? fmt::format("{} and {} more", text, names.size() - told) : text;
}

/// A list whose truth has no mean is one whose mean is not separable.
void TakeOutMean(CurveScore& curve) {
  double largest = 0.0;
  for (const double value : curve.truth) largest = std::max(largest, std::abs(value));
  if (curve.truth.size() < 3 || std::abs(MeanOfAll(curve.truth)) > 1e-9 * largest) return;
  const double mean = MeanOfAll(curve.estimate);
  for (double& value : curve.estimate) value -= mean;
}

}  // namespace

ResultTable ErrorTable(const Evaluation& evaluation) {
  std::string text = "result,position,position_of,value,u\n";
  std::set<std::string> written;
  AddRows(evaluation.separation, "", written, text);
  AddRows(evaluation.results, "results.", written, text);
  return {"errors.csv", text};
}

ScoredRun ScoreAgainst(const std::vector<ScoredValue>& truth, const std::string& file) {
  const CsvTable csv = ReadCsv(file);
  const std::map<std::string, Own> own = OwnOf(csv);
  std::map<std::string, std::pair<CurveScore, CurveScore>> lists;  // the user's and the program's
  for (const ScoredValue& v : truth) {
    const auto found = own.find(v.name);
    if (found == own.end() || !std::isfinite(found->second.value)) continue;
    const std::string list = uncertainty::KindOf(v.name);
    auto& [mine, program] = lists.try_emplace(list, CurveNamed(list, "yours "), CurveNamed(list, "twinbench ")).first->second;
    AddPoint(found->second.value, found->second.u, v, mine);
    AddPoint(v.value, v.u, v, program);
  }
  std::vector<std::string> names;
  for (const ScoredValue& v : truth) names.push_back(v.name);
  if (lists.empty() && !own.empty() && !names.empty())
    throw InputError(csv.WhereHeader(), "none of its results has a truth",
                     fmt::format("a name as {}", Nearest(own.begin()->first, names)));
  if (lists.empty()) throw InputError(file, "it has no result that could be compared", "a row for each result");
  std::vector<CurveScore> curves;
  ScoredRun scored;
  std::set<std::string> known(names.begin(), names.end());
  std::vector<std::string> unknown, certain;  // the user's names without a truth, and those whose u is zero
  for (const auto& [name, number] : own) {
    if (!known.contains(name)) unknown.push_back(name);
    if (number.u == 0.0 && known.contains(name)) certain.push_back(name);
  }
  std::size_t compared = 0;
  for (auto& [list, both] : lists) {
    compared += both.first.truth.size();
    TakeOutMean(both.first);
    curves.push_back(both.first);
    curves.push_back(both.second);
  }
  scored.json = ToJson(curves);
  scored.text = fmt::format("{} of {} results in {} are compared with the truth\n", compared, own.size(), file) + ScoreTable(curves);
  if (!unknown.empty()) scored.text += fmt::format("no truth is known of {}\n", FirstNames(unknown));
  if (!certain.empty()) scored.text += fmt::format("u is 0, so that (error/u)^2 leaves it out, of {}\n", FirstNames(certain));
  scored.positions = PositionTable(curves);
  scored.values = ValuesOf(curves);
  return scored;
}

}  // namespace twinbench::report
