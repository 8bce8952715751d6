#include "twin/import/circle_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/formula_functions.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// A column of one axis, and one that stays beside it.
struct AxisOnCircle {
  const Column* commanded = nullptr;
  const Column* actual = nullptr;  // null: none
};

bool HasLength(const Column& column) {
  const auto unit = UnitNamed(column.unit);
  return unit && unit->dimension == Dimension::kLength;
}

bool MayBePlace(const Column& column) {
  constexpr std::ptrdiff_t kSeldom = 4;  // times as many rows as values
  if (!column.IsNumber() || IsCalledError(column.name) || IsRate(column)) return false;
  if (!HasLength(column) && !IsNoUnit(column.unit)) return false;
  const std::vector<double> steps = StepsOf(column.value);
  return kSeldom * std::ranges::count_if(steps, [](double step) { return step != 0.0; }) > std::ssize(steps);
}

double SpanOf(const std::vector<double>& x) { return QuantileOf(x, 0.99) - QuantileOf(x, 0.01); }

/// An axis that follows late is still near where it was sent.
bool StayTogether(const Column& a, const Column& b) {
  constexpr double kNear = 0.1;  // of the way
  std::vector<double> apart;
  for (std::size_t i = 0; i < a.value.size(); ++i)
    if (std::isfinite(a.value[i] - b.value[i])) apart.push_back(std::abs(a.value[i] - b.value[i]));
  return a.unit == b.unit && !apart.empty() && MedianOf(std::move(apart)) < kNear * SpanOf(a.value);
}

/// Each column with the one that stays beside it.
std::vector<AxisOnCircle> AxesOf(const Track& track) {
  std::vector<const Column*> places;
  for (const Column& column : track.columns)
    if (MayBePlace(column)) places.push_back(&column);
  std::vector<AxisOnCircle> axes;
  std::set<const Column*> taken;
  for (const Column* first : places) {
    if (!taken.insert(first).second) continue;
    const auto beside = std::ranges::find_if(places, [&](const Column* c) { return !taken.contains(c) && StayTogether(*first, *c); });
    if (beside != places.end()) taken.insert(*beside);
    axes.push_back({first, beside == places.end() ? nullptr : *beside});
  }
  return axes;
}

/// "x" before "y" before "z" where names say so; else as the file has them.
bool IsBefore(const AxisOnCircle& a, const AxisOnCircle& b) {
  const auto letter = [](const AxisOnCircle& axis) {
    for (const char* name : {"x", "y", "z"})
      if (ClearnessBy(axis.commanded->name, {name}) > 0) return *name;
    return '\0';
  };
  return letter(a) != '\0' && letter(b) != '\0' && letter(a) < letter(b);
}

/// Commanded is what a name calls so, or what is not called measured beside what is, or what lies closer to one circle.
void TellCommanded(AxisOnCircle& one, AxisOnCircle& other) {
  const auto side = [](const Column& c) { return IsCalledCommand(c.name) ? 1 : Clearness(c.name, Speaks::kDevice) > 0 ? -1 : 0; };
  const int said = side(*one.commanded) - side(*one.actual);
  const auto away = [](const Column& a, const Column& b) { return AwayFromCircle(a.value, b.value); };
  const bool is_wrong = said != 0 ? said < 0 : away(*one.actual, *other.actual) < away(*one.commanded, *other.commanded);
  if (!is_wrong) return;
  std::swap(one.commanded, one.actual);
  std::swap(other.commanded, other.actual);
}

/// Two axes that go round a circle together, and no others beside them; nothing else.
std::optional<std::array<AxisOnCircle, 2>> PairOnCircle(const std::vector<AxisOnCircle>& axes) {
  if (axes.size() != 2 || std::isnan(AwayFromCircle(axes[0].commanded->value, axes[1].commanded->value))) return std::nullopt;
  return IsBefore(axes[1], axes[0]) ? std::array{axes[1], axes[0]} : std::array{axes[0], axes[1]};
}

/// What the map calls where an axis was: "actual" or "measured"; empty: it seeks no circle.
std::string ShownIn(const Map& map) {
  for (const char* name : {"actual", "measured"})
    if (std::ranges::find(map.sought, fmt::format("{}_1_mm", name), &Sought::name) != map.sought.end()) return name;
  return "";
}

bool IsLong(const Column& column) {
  constexpr double kLeast_m = 1e-3;  // less is the way of an artefact under probes
  const auto unit = UnitNamed(column.unit);
  return unit && HasLength(column) && SpanOf(column.value) * unit->to_SI > kLeast_m;
}

}  // namespace

std::map<std::string, std::string> ColumnsOnCircle(const Map& map, Track& track, std::vector<std::string>& remarks) {
  constexpr std::size_t kFewestRows = 30;  // three go round any circle
  const std::string shown = ShownIn(map);
  if (shown.empty() || track.Rows() < kFewestRows) return {};
  const bool are_pairs = std::ranges::find(map.sought, "commanded_1_mm", &Sought::name) != map.sought.end();
  std::vector<AxisOnCircle> axes = AxesOf(track);
  const bool others = std::ranges::any_of(axes, [are_pairs](const AxisOnCircle& a) { return !are_pairs && a.actual; });
  std::erase_if(axes, [are_pairs](const AxisOnCircle& a) { return are_pairs ? !a.actual : !IsLong(*a.commanded); });
  auto pair = others ? std::nullopt : PairOnCircle(axes);
  if (!pair) return {};
  auto& [one, other] = *pair;
  if (are_pairs) TellCommanded(one, other);
  std::map<std::string, std::string> columns = {{shown + "_1_mm", (are_pairs ? one.actual : one.commanded)->name}, {shown + "_2_mm", (are_pairs ? other.actual : other.commanded)->name}};
  std::string said = fmt::format("\"{}\" and \"{}\" go round a circle", one.commanded->name, other.commanded->name);
  if (are_pairs) {
    columns.insert({{"commanded_1_mm", one.commanded->name}, {"commanded_2_mm", other.commanded->name}});
    said += fmt::format(": taken as commanded, \"{}\" and \"{}\" beside them as actual", one.actual->name, other.actual->name);
  }
  for (Column& column : track.columns) {
    const bool is_one = std::ranges::any_of(columns, [&column](const auto& c) { return c.second == column.name; });
    if (!is_one || HasLength(column)) continue;
    column.unit = "mm";
    if (said.find("unit") == std::string::npos) said += "; the unit is not said and taken as mm";
  }
  remarks.push_back(said);
  return columns;
}

}  // namespace twinbench::imports
