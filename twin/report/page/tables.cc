#include "twin/report/page/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "twin/report/page/named_numbers.h"
#include "twin/report/page/scored.h"
#include "twin/report/page/walk.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

constexpr std::size_t kMostRowsOfASpectrum = 20;

const json* BudgetOf(const json& results, const std::string& path) {
  if (!results.contains("uncertainty_budget")) return nullptr;
  for (const json& budget : results.at("uncertainty_budget")) {
    if (budget.value("name", "") == path) return &budget;
  }
  return nullptr;
}

/// One number of the results, however the file writes it.
struct Value {
  std::string path, name, unit;
  double value, u;
};

void AddRow(const json& results, const json& score, const Value& value, PageTable& table) {
  const json* budget = BudgetOf(results, value.path);
  const double u = budget ? NumberAt(*budget, "u") : value.u;
  const std::vector<double> truth = TruthOf(score, value.path, 1);
  table.rows.push_back({value.name, NumberText(value.value, u), value.unit, NumberText(u, u),
                        budget ? NumberText(NumberAt(*budget, "k"), 0.01) : "",
                        budget ? NumberText(NumberAt(*budget, "U"), NumberAt(*budget, "U")) : "",
                        truth.empty() ? "" : NumberText(truth[0], u)});
}

std::string Joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// { "value": 3, "u": 1, "unit": "um" }: the key of the object may end in the unit, or its parent's.
Value MeasuredValue(const std::string& path, const json& object) {
  const std::size_t dot = path.rfind('.');
  NamedUnit named = NameAndUnit(dot == std::string::npos ? path : path.substr(dot + 1));
  const std::string parent = dot == std::string::npos ? "" : path.substr(0, dot);
  const NamedUnit above = NameAndUnit(parent);
  std::string unit = UnitText(object.value("unit", named.unit.empty() ? above.unit : named.unit));
  const std::string before = PathInWords(named.unit.empty() && !above.unit.empty() ? above.name : parent);
  return {path, (before.empty() ? "" : before + " ") + named.name, unit, NumberAt(object, "value"),
          NumberAt(object, "u")};
}

bool IsMeasured(const json& node) {
  return node.is_object() && node.contains("value") && (node.at("value").is_number() || node.at("value").is_null());
}

/// Plain numbers of one object; what is the u of another stands beside it.
void AddNumbers(const json& results, const json& score, const std::string& path, const json& object,
                PageTable& table) {
  for (const auto& [key, node] : object.items()) {
    if (!node.is_number() || (key.starts_with("u_") && object.contains(key.substr(2)))) continue;
    const auto [name, unit] = NameAndUnit(key);
    const std::string before = PathInWords(path);
    AddRow(results, score,
           {Joined(path, key), (before.empty() ? "" : before + " ") + name, unit, node.get<double>(),
            NumberAt(object, "u_" + key)},
           table);
  }
}

void EnterNumbers(const json& results, const json& score, const std::string& path, const json& node,
                  PageTable& table) {
  if (!node.is_object()) return;
  if (IsMeasured(node)) return AddRow(results, score, MeasuredValue(path, node), table);
  AddNumbers(results, score, path, node, table);
  for (const auto& [key, value] : node.items()) {
    if (!(path.empty() && key == "diagnosis") && key != "u_parts")
      EnterNumbers(results, score, Joined(path, key), value, table);
  }
}

/// Columns that no row fills tell nothing.
PageTable WithoutEmptyColumns(PageTable table) {
  for (std::size_t c = table.columns.size(); c-- > 0;) {
    const auto is_empty = [c](const std::vector<std::string>& row) { return row[c].empty(); };
    if (!std::all_of(table.rows.begin(), table.rows.end(), is_empty)) continue;
    table.columns.erase(table.columns.begin() + static_cast<std::ptrdiff_t>(c));
    for (auto& row : table.rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(c));
  }
  return table;
}

/// @param u  Of a number; NaN: it has none.
std::string CellText(const json& value, double u) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_number()) return "";
  return MeasuredText(value.get<double>(), u, "");
}

bool IsPlain(const json& value) {
  return value.is_string() || value.is_number() || value.is_boolean();
}

/// {"value_um": 3, "u_um": 1}: the unit; nothing if it is none of these.
std::optional<std::string> UnitOfValue(const json& node) {
  constexpr std::string_view kValueIn = "value_";
  if (!node.is_object()) return {};
  for (const auto& [key, value] : node.items())
    if (key.starts_with(kValueIn) && (value.is_number() || value.is_null())) return key.substr(kValueIn.size());
  return {};
}

/// The members of a group whose values have their unit in their keys: {"total": {"value_um", "u_um"}, ...}. One
/// column each, whatever the unit: a row of tilts stands beside one of displacements.
void AddGroup(const json& group, std::map<std::string, std::string>& cells) {
  if (!group.is_object()) return;
  for (const auto& [key, member] : group.items()) {
    const std::optional<std::string> unit = UnitOfValue(member);
    if (!unit) continue;
    const double value = NumberAt(member, "value_" + *unit), u = NumberAt(member, "u_" + *unit);
    cells[key] = MeasuredText(value, u, *unit);
  }
}

/// Plain members of an object, the values of its measured ones, and those of groups of such.
std::map<std::string, std::string> CellsOf(const json& object) {
  std::map<std::string, std::string> cells;
  for (const auto& [key, value] : object.items()) {
    AddGroup(value, cells);
    const bool is_uncertainty = key.starts_with("u_") && object.contains(key.substr(2));
    if (IsPlain(value) && !is_uncertainty) cells[key] = CellText(value, NumberAt(object, "u_" + key));
    if (IsMeasured(value)) {
      cells[key] = CellText(value.at("value"), NumberAt(value, "u"));
    }
  }
  if (!IsMeasured(object)) return cells;
  cells["value"] = MeasuredText(NumberAt(object, "value"), NumberAt(object, "u"), TextAt(object, "unit"));
  for (const char* said : {"u", "unit", "key"}) cells.erase(said);  // with the value, and in words
  return cells;
}

bool IsListOfObjects(const json& node) {
  return node.is_array() && !node.empty() &&
         std::all_of(node.begin(), node.end(), [](const json& e) { return e.is_object(); });
}

/// Orders with their amplitudes are a spectrum, points of a pass are a curve.
bool HasFigure(const json& list) {
  return (list.front().contains("order") && list.size() > kMostRowsOfASpectrum) ||
         list.front().contains("commanded_deg");
}

std::string ColumnTitle(const std::string& key) {
  const auto [name, unit] = NameAndUnit(key);
  return unit.empty() ? name : name + " [" + unit + "]";
}

/// What a row is of stands before what was found.
std::ptrdiff_t PlaceOf(const std::string& key) {
  constexpr auto kFirst =
      std::to_array<std::string_view>({"setup", "pass", "order", "table", "motion", "position_deg", "instrument",
                                       "direction", "feed_mm_min", "radius_mm", "head_deg", "error", "value"});
  return std::ranges::find(kFirst, key) - kFirst.begin();
}

/// A few rows of many columns are no wider than a page when they lie on their side.
PageTable OnItsSide(const PageTable& table) {
  PageTable turned{table.title, {table.columns.front()}, {}};
  for (const auto& row : table.rows) turned.columns.push_back(row.front());
  for (std::size_t c = 1; c < table.columns.size(); ++c) {
    std::vector<std::string>& line = turned.rows.emplace_back(1, table.columns[c]);
    for (const auto& row : table.rows) line.push_back(row[c]);
  }
  return turned;
}

std::optional<PageTable> TableOfObjects(const std::string& title, const json& list) {
  std::vector<std::map<std::string, std::string>> all;
  std::set<std::string> keys;
  for (const json& object : list) {
    all.push_back(CellsOf(object));
    for (const auto& [key, text] : all.back()) keys.insert(key);
  }
  if (keys.size() < 2) return {};
  std::vector<std::string> columns(keys.begin(), keys.end());
  std::ranges::stable_sort(columns, {}, PlaceOf);
  PageTable table{title, {}, {}};
  for (const std::string& key : columns) table.columns.push_back(ColumnTitle(key));
  for (auto& cells : all) {
    std::vector<std::string>& row = table.rows.emplace_back();
    for (const std::string& key : columns) row.push_back(cells[key]);
  }
  constexpr std::size_t kMostColumns = 10;
  return columns.size() > std::max(kMostColumns, all.size()) ? OnItsSide(table) : table;
}

}  // namespace

PageTable ValueTable(const json& results, const json& score) {
  PageTable table{"Values", {"quantity", "value", "unit", "u", "k", "U", "truth"}, {}};
  EnterNumbers(results, score, "", results, table);
  return WithoutEmptyColumns(table);
}

PageTable ListTable(const json& results) {
  PageTable table{"Results and their uncertainty", {"quantity", "unit", "values", "u (rms)", "k", "U"}, {}};
  if (!results.contains("uncertainty_budget")) return table;
  for (const json& budget : results.at("uncertainty_budget")) {
    const auto [name, unit] = NameAndUnit(budget.value("name", ""));
    const double u = NumberAt(budget, "u");
    table.rows.push_back({PathInWords(name), unit, NumberText(NumberAt(budget, "values")), NumberText(u, u),
                          NumberText(NumberAt(budget, "k"), 0.01),
                          NumberText(NumberAt(budget, "U"), NumberAt(budget, "U"))});
  }
  return WithoutEmptyColumns(table);
}

Figure BudgetFigure(const json& results) {
  Figure figure{
      FigureForm::kShares, "Where the uncertainty comes from", "", {"", ""}, {"share of the variance", ""}, {}};
  if (!results.contains("uncertainty_budget")) return figure;
  const json& budgets = results.at("uncertainty_budget");
  std::map<std::string, std::vector<double>> shares;
  for (std::size_t k = 0; k < budgets.size(); ++k) {
    figure.categories.push_back(PathInWords(NameAndUnit(budgets[k].value("name", "")).name));
    for (const json& source : budgets[k].value("sources", json::array())) {
      std::vector<double>& share = shares[source.value("source", "")];
      share.resize(budgets.size(), 0.0);
      share[k] += NumberAt(source, "share");
    }
  }
  for (const auto& [source, share] : shares)
    figure.series.push_back({source, SeriesRole::kEstimate, {}, share, {}});
  return figure;
}

PageTable NotSeparableTable(const json& results) {
  PageTable table{"Not separable by this design", {"what", "why"}, {}};
  ForEachObject(results, [&](const std::string&, const json& object) {
    if (!object.contains("not_separable") || !object.at("not_separable").is_array()) return;
    for (const json& lost : object.at("not_separable")) {
      if (lost.is_object()) {
        const json what = lost.value("what", json(""));
        table.rows.push_back({what.is_string() ? what.get<std::string>() : what.dump(), lost.value("why", "")});
      }
      if (lost.is_string()) table.rows.push_back({lost.get<std::string>(), ""});
    }
  });
  std::sort(table.rows.begin(), table.rows.end());
  table.rows.erase(std::unique(table.rows.begin(), table.rows.end()), table.rows.end());
  return table;
}

std::vector<PageTable> ObjectTables(const json& results) {
  std::vector<PageTable> tables;
  ForEachObject(results, [&](const std::string& path, const json& object) {
    for (const auto& [key, value] : object.items()) {
      if (key == "not_separable" || key == "uncertainty_budget" || key == "diagnosis" || !IsListOfObjects(value) ||
          HasFigure(value))
        continue;
      if (auto table = TableOfObjects(CurveTitle(Joined(path, key), ""), value))
        tables.push_back(std::move(*table));
    }
  });
  return tables;
}

}  // namespace twinbench::report
