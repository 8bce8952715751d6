#include "twin/import/choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/counts.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// A joint's angle as robots have it, or one that goes round by 2 pi and not by whole numbers.
bool LooksLikeRad(const Choice& from) {
  constexpr double kNearlyATurn_rad = 0.95 * units::turn, kBeyond_rad = 0.01;
  if (IsCalledJoint(from.name)) return true;
  const std::vector<double>& values = from.column->value;
  const auto [low, high] = std::ranges::minmax(values);
  const double from_rad = low < -kBeyond_rad ? -units::turn / 2.0 : 0.0;
  const auto is_whole = [](double x) { return x == std::round(x); };
  return high - low > kNearlyATurn_rad && low > from_rad - kBeyond_rad && high < from_rad + units::turn + kBeyond_rad &&
         2 * std::ranges::count_if(values, is_whole) < std::ssize(values);
}

/// Of a column that says none: as the other one that it is compared with, or as such files have it.
std::string UsualUnit(const Choice& from, const std::string& target, const Map& map) {
  constexpr double kTwoTurns_rad = 12.6;
  const auto wanted = UnitAtEnd(target);
  for (const MappedColumn& other : map.columns) {
    const auto unit = UnitAtEnd(other.column);
    if (unit && wanted && unit->dimension == wanted->dimension && !other.unit.empty()) return other.unit;
  }
  if (wanted && wanted->dimension == Dimension::kAngle && IsCalledLength(from.name)) return "mm";
  if (wanted && wanted->dimension == Dimension::kAngle && StaysWithin(*from.column, kTwoTurns_rad))
    return LooksLikeRad(from) ? "rad" : from.recording->usual_angle;
  return wanted ? std::string(wanted->name) : "";
}

[[noreturn]] void RefuseUnit(const Choice& from, const std::string& target) {
  const std::vector<Dimension> wanted = {Dimension::kAngle, Dimension::kLength};
  std::string known;
  for (const Dimension dimension : wanted) {
    for (const NamedUnit& unit : UnitsOf(dimension)) known += (known.empty() ? "" : ", ") + std::string(unit.name);
  }
  throw InputError(from.recording->file, fmt::format("\"{}\" is in \"{}\", which is no unit of an angle or a length", from.name, from.column->unit),
                   fmt::format("{}{}; or a formula, as in --column '{}=[{}] * 360 / 4096' of 4096 counts per turn", known, NearestUnit(from.column->unit, wanted), target, from.name));
}

}  // namespace

std::vector<Choice> NumberColumns(const std::vector<Recording>& recordings) {
  std::vector<Choice> all;
  for (const Recording& recording : recordings) {
    for (const Track& track : recording.tracks) {
      for (const Column& column : track.columns) {
        const bool again =
            std::ranges::find(all, column.name, [](const Choice& c) { return c.column->name; }) != all.end();
        if (column.IsNumber() && !(again && (recording.parts_are_setups || recordings.size() > 1)))
          all.push_back({column.name, &column, &track, &recording});
      }
    }
  }
  return all;
}

bool Changes(const Choice& choice) {
  return std::ranges::any_of(choice.column->value, [&](double x) { return x != choice.column->value[0]; });
}

bool IsCounter(const Column& column) {
  const std::vector<double> steps = StepsOf(column.value);
  return column.unit.empty() && steps.size() + 1 == column.value.size() && std::ranges::all_of(steps, [](double step) { return step == 1.0; });
}

bool IsGiven(const Map& map, const std::string& column) {
  return std::ranges::any_of(map.columns, [&column](const MappedColumn& c) { return c.column == column; });
}

std::string GivenExpression(const Map& map, const std::string& column) {
  const auto found = std::ranges::find(map.columns, column, &MappedColumn::column);
  return found == map.columns.end() ? "" : found->expression;
}

std::string UnitFor(const Column& column, const std::string& target) {
  const auto wanted = UnitAtEnd(target);
  const auto has = UnitNamed(column.unit);
  if (!wanted || !has) return "";
  const bool fits = has->dimension == wanted->dimension ||
                    (wanted->dimension == Dimension::kAngle && has->dimension == Dimension::kLength);
  return fits ? std::string(has->name) : "";
}

bool StaysWithin(const Column& column, double limit) {
  return std::ranges::all_of(column.value, [limit](double x) { return !(std::abs(x) > limit); });
}

std::set<std::string> Taken(const Map& map) {
  std::set<std::string> taken;
  for (const MappedColumn& column : map.columns) {
    taken.insert(column.expression);
    const std::size_t open = column.expression.find('['), close = column.expression.find(']');
    if (open < close && close != std::string::npos) taken.insert(column.expression.substr(open + 1, close - open - 1));
  }
  return taken;
}

void Put(const std::string& target, const Choice& from, const std::string& why, Map& map,
         std::vector<std::string>& remarks) {
  const std::string own = UnitFor(*from.column, target);
  const auto wanted = UnitAtEnd(target);
  if (own.empty() && wanted && TakeCounts(target, *from.column, *from.track, map, remarks)) return;
  const bool is_counts = IsCalledCounts(*from.column);  // judged with what it is compared with
  if (own.empty() && wanted && !is_counts && !IsNoUnit(from.column->unit)) RefuseUnit(from, target);
  const std::string unit = own.empty() ? UsualUnit(from, target, map) : own;
  if (SmallLetters(from.column->unit) == "grad")
    remarks.push_back(fmt::format("\"{}\" is in grad, read as degrees; where 400 are a turn: --column '{}_gon={}'", from.name, BaseOf(target), from.name));
  map.columns.push_back({target, from.name, unit, ""});
  std::string line = fmt::format("{} is taken from \"{}\"", target, from.name);
  if (!why.empty()) line += ", " + why;
  if (own.empty() && wanted) {
    const bool may_be_rad = unit == "deg" && SaysNothing(from.name) && StaysWithin(*from.column, units::turn);
    line += fmt::format("; its unit is not said and taken as {}{}", unit, may_be_rad ? fmt::format(" (in rad: --column '{}_rad=[{}]')", BaseOf(target), from.name) : "");
  }
  if (!why.empty() || (own.empty() && wanted)) remarks.push_back(line);
}

}  // namespace twinbench::imports
