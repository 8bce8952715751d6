#include "twin/import/stacked.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "twin/import/clampings.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/run_names.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

bool IsAnAngle(const Sought& sought) {
  const auto unit = UnitAtEnd(sought.name);
  return unit && unit->dimension == Dimension::kAngle;
}

/// Whether it says where, not what was read there: the first quantity of the map is the place.
bool SaysWhere(const Map& map, const Column& column) {
  int as_place = 0, as_value = 0;
  bool are_angles_read = false;
  for (const Sought& sought : map.sought) {
    const bool is_place = &sought == &map.sought.front();
    (is_place ? as_place : as_value) = std::max(is_place ? as_place : as_value, ClearnessBy(column.name, sought.words));
    are_angles_read |= !is_place && sought.kind == "value" && IsAnAngle(sought);
  }
  if (are_angles_read) return as_place > as_value;
  if (const auto unit = UnitNamed(column.unit)) return unit->dimension == Dimension::kAngle;
  return std::ranges::any_of(map.sought, [&column](const Sought& sought) {
    return IsAnAngle(sought) && ClearnessBy(column.name, sought.words) > 0;
  });
}

/// "CCW", or one of its words says which way: "reading forward".
int WayIn(const std::string& name) {
  constexpr auto kForward = std::to_array<std::string_view>({"forward", "fwd", "up", "vorwärts", "vorwaerts", "vorw", "vor", "hin", "aller", "andata", "ida", "increasing", "ascending"});
  constexpr auto kBack = std::to_array<std::string_view>({"reverse", "rev", "backward", "backwards", "bwd", "back", "down", "rückwärts", "rueckwaerts", "rückw", "rück", "rueck",
                                                       "zurück", "zurueck", "retour", "ritorno", "vuelta", "decreasing", "descending"});
  if (const int turn = TurnIn(name); turn != 0) return turn;
  const std::string words = SmallLetters(name) + ' ';
  for (std::size_t from = 0, end; (end = words.find_first_of(" _-.", from)) != std::string::npos; from = end + 1) {
    const std::string_view word = std::string_view(words).substr(from, end - from);
    if (std::ranges::count(kForward, word) > 0) return 1;
    if (std::ranges::count(kBack, word) > 0) return -1;
  }
  return 0;
}

/// What of a table was read one way round, in one clamping, or in one run of several.
struct ColumnSide {
  int turn = 0;  // 0: the name says none
  ClampingSaid clamping;
  std::string run;  // "run 2" of columns that are called so and no more

  bool IsOne() const { return turn != 0 || clamping.Any() || !run.empty(); }
  bool operator==(const ColumnSide&) const = default;
};

ColumnSide SideOf(const Map& map, const Column& column) {
  if (!SeeksClampings(map)) return {WayIn(column.name), {}, {}};
  const std::string bare = BareName(column.name);
  return {WayIn(column.name), ClampingOf(column), bare.find_first_of("123456789") != std::string::npos && NumbersARun(bare) ? bare : ""};
}

/// "CCW [µm]" says a way round and a unit only: it is the quantity that has such a unit. "clamping 2" is what was
/// read there.
std::string OwnNameOf(const Map& map, const Column& column, const ColumnSide& side) {
  for (const Sought& sought : map.sought) {
    if (ClearnessBy(column.name, sought.words) > 0 && sought.kind == "value") return column.name;
  }
  const auto unit = UnitNamed(column.unit);
  for (const Sought& sought : map.sought) {
    if (sought.kind != "value" || &sought == &map.sought.front() || sought.words.empty()) continue;
    const auto own = UnitAtEnd(sought.name);
    if (side.clamping.Any() || (own && (!unit || unit->dimension == own->dimension))) return sought.words.front();
  }
  return column.name;
}

/// "x forward" of "Y forward": the name that the other axis has beside it; empty: it names no y.
std::string NameOfX(const std::string& name) {
  std::string small = SmallLetters(name);
  const auto is_letter = [&small](std::size_t i) { return i < small.size() && (std::isalpha(static_cast<unsigned char>(small[i])) || static_cast<unsigned char>(small[i]) >= 0x80); };
  for (std::size_t at = 0; (at = small.find('y', at)) != std::string::npos; ++at) {
    if (is_letter(at + 1) || (at > 0 && is_letter(at - 1))) continue;
    small[at] = 'x';
    return small;
  }
  return "";
}

/// What a second axis of the instrument showed beside a column of that name in small letters, where the map seeks such.
std::map<std::string, const Column*> SecondAxes(const Map& map, const Track& track) {
  const auto is_second = [](const Sought& sought) { return sought.kind == "column" && std::ranges::count(sought.words, "y") > 0; };
  std::map<std::string, const Column*> by_x;
  if (std::ranges::none_of(map.sought, is_second)) return by_x;
  for (const Column& column : track.columns) {
    const std::string x = column.IsNumber() ? NameOfX(column.name) : "";
    if (!x.empty()) by_x.emplace(x, &column);
  }
  return by_x;
}

struct Part {
  const Column* value;
  const Column* beside;  // null: none
  const Column* angle;   // null: that of all
  ColumnSide side;
};

std::vector<Part> PartsOf(const Map& map, const Track& track) {
  std::vector<Part> parts;
  const std::map<std::string, const Column*> second_axes = SecondAxes(map, track);
  std::vector<const Column*> beside;
  for (const Column& column : track.columns) {
    const auto second = second_axes.find(SmallLetters(column.name));
    beside.push_back(second == second_axes.end() ? nullptr : second->second);
  }
  for (const Column& column : track.columns) {
    const ColumnSide side = column.IsNumber() ? SideOf(map, column) : ColumnSide{};
    if (!side.IsOne() || SaysWhere(map, column) || std::ranges::count(beside, &column) > 0) continue;
    const auto angle = std::ranges::find_if(track.columns, [&](const Column& c) {
      return c.IsNumber() && SaysWhere(map, c) && SideOf(map, c) == side;
    });
    parts.push_back({&column, beside[static_cast<std::size_t>(&column - track.columns.data())], angle == track.columns.end() ? nullptr : &*angle, side});
  }
  return parts;
}

/// "x 30 deg" has the angle of its clamping behind it, not its own unit.
std::string UnitOfValues(const Part& part) {
  const auto unit = UnitNamed(part.value->unit);
  return part.side.clamping.ends_in_angle && unit && unit->name == "deg" ? "" : part.value->unit;
}

/// Columns of the rows in which each part has a value.
class Stack {
 public:
  Stack(const Map& map, const Track& track, const std::vector<Part>& parts)
      : map_(map), track_(track), parts_(parts) {
    for (const Column& column : track.columns) {
      if (IsShared(column)) shared_.push_back({column.name, column.unit, {}, column.words});
    }
    value_ = {OwnNameOf(map, *parts.front().value, parts.front().side), UnitOfValues(parts.front()), {}, {}};
    if (parts.front().beside) beside_ = {"y", parts.front().beside->unit, {}, {}};
    if (parts.front().angle) angle_ = {"angle", parts.front().angle->unit, {}, {}};
  }

  void Into(Track& track) {
    for (std::size_t k = 0; k < parts_.size(); ++k) Take(parts_[k], static_cast<double>(k));
    std::vector<Column> columns = std::move(shared_);
    for (Column* column : {&angle_, &value_, &beside_, &direction_, &run_, &clamping_, &offset_}) {
      if (std::ranges::any_of(column->value, [](double x) { return std::isfinite(x); }))
        columns.push_back(std::move(*column));
    }
    track.columns = std::move(columns);
    track.time_s.resize(track.Rows());
    for (std::size_t i = 0; i < track.time_s.size(); ++i) track.time_s[i] = static_cast<double>(i);
    track.clock = "none";  // they were not taken side by side
  }

 private:
  bool IsShared(const Column& column) const { return !SideOf(map_, column).IsOne(); }

  /// Which way the places go that ways share; 0: nothing says so.
  int WayOfRows() const {
    const auto place = std::ranges::find_if(track_.columns, [this](const Column& c) { return c.IsNumber() && IsShared(c) && SaysWhere(map_, c); });
    if (place == track_.columns.end()) return 0;
    const std::vector<double> steps = StepsOf(place->value);
    const auto up = std::ranges::count_if(steps, [](double step) { return step > 0.0; });
    return 2 * up > std::ssize(steps) ? 1 : -1;
  }

  /// Rows that ways share are gone through forward one way and back the other way.
  void Take(const Part& part, double run) {
    const int forward = WayOfRows() != 0 && part.side.turn != 0 ? WayOfRows() : parts_.front().side.turn;
    const bool is_back = !part.angle && part.side.turn != forward;
    for (std::size_t k = 0; k < track_.Rows(); ++k) {
      const std::size_t row = is_back ? track_.Rows() - 1 - k : k;
      if (!std::isfinite(part.value->value[row])) continue;
      std::size_t kept = 0;
      for (const Column& column : track_.columns) {
        if (IsShared(column)) shared_[kept++].value.push_back(column.value[row]);
      }
      if (part.angle) angle_.value.push_back(part.angle->value[row]);
      value_.value.push_back(part.value->value[row]);
      beside_.value.push_back(part.beside ? part.beside->value[row] : kNaN);
      direction_.value.push_back(part.side.turn == 0 ? kNaN : part.side.turn);
      run_.value.push_back(run);
      clamping_.value.push_back(part.side.clamping.number);
      offset_.value.push_back(part.side.clamping.turned_deg);
    }
  }

  const Map& map_;
  const Track& track_;
  const std::vector<Part>& parts_;
  std::vector<Column> shared_;
  Column angle_, value_, beside_, direction_{"direction", "", {}, {}}, run_{"run", "", {}, {}},
      clamping_{"clamping", "", {}, {}}, offset_{"offset", "deg", {}, {}};
};

/// "rev" is a way back beside a way there only; else a revolution.
void NameRevolutions(Track& track) {
  if (std::ranges::any_of(track.columns, [](const Column& c) { return WayIn(c.name) > 0; })) return;
  for (Column& column : track.columns) {
    const std::string small = SmallLetters(column.name);
    if (small.starts_with("rev") && !small.starts_with("reve")) column.name = "revolution" + column.name.substr(3);
  }
}

}  // namespace

void StackTurns(const Map& map, Track& track) {
  if (std::ranges::find(map.sought, "turn", &Sought::kind) == map.sought.end()) return;
  NameRevolutions(track);
  TakeClampingLines(map, track);
  const Track whole = track;
  const std::vector<Part> parts = PartsOf(map, whole);
  if (!parts.empty()) Stack(map, whole, parts).Into(track);
}

}  // namespace twinbench::imports
