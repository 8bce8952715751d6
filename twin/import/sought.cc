#include "twin/import/sought.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/import/circle_columns.h"
#include "twin/import/clampings.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/counts.h"
#include "twin/import/expression.h"
#include "twin/import/join.h"
#include "twin/import/places_said.h"
#include "twin/import/stacked.h"
#include "twin/import/statements.h"

namespace twinbench::imports {
namespace {

NamedUnit UnitOf(const Sought& sought) {
  return UnitAtEnd(sought.name).value_or(NamedUnit{});
}

/// Whether a column can be the quantity by its unit. Without one it may be; with one that is not known it is
/// something else, but for counts of an angle of which a turn has a known number.
bool UnitFits(const Column& column, const Sought& sought, const Track& track) {
  const auto has = UnitNamed(column.unit);
  const auto wanted = UnitOf(sought).dimension;
  if (has) return has->dimension == wanted;
  if (wanted == Dimension::kAngle && IsRate(column)) return false;
  if (wanted == Dimension::kAngle && IsCalledCounts(column)) return CountsPerTurnOf(column, track, sought.words).has_value();
  return IsNoUnit(column.unit);
}

double ShareOfChanges(const Column& column) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < column.value.size(); ++i) changes += column.value[i] != column.value[i - 1] ? 1 : 0;
  return static_cast<double>(changes) / std::max(1.0, static_cast<double>(column.value.size()) - 1.0);
}

bool IsTurn(const Column& column) {
  return column.IsNumber() && std::ranges::all_of(column.value, [](double x) { return x == 1.0 || x == -1.0; });
}

/// High in a few rows of each turn.
bool IsPulse(const Column& column) {
  constexpr double kMostHigh = 0.3;
  constexpr int kFewestTurns = 3;
  if (!column.IsNumber() || column.value.empty()) return false;
  const auto [low, high] = std::ranges::minmax(column.value);
  int rises = 0;
  double up = 0.0;
  bool was = true;
  for (const double x : column.value) {
    const bool is = x > 0.5 * (low + high);
    rises += is && !was ? 1 : 0;
    up += is ? 1.0 : 0.0;
    was = is;
  }
  return rises >= kFewestTurns && up < kMostHigh * static_cast<double>(column.value.size());
}

/// The radius of a circle is no deviation from it.
bool IsTooLarge(const Column& column, const Sought& sought) {
  if (!(sought.most > 0.0)) return false;
  const auto has = UnitNamed(column.unit);
  std::vector<double> sizes;
  for (const double x : column.value) sizes.push_back(std::abs(x));
  return MedianOf(std::move(sizes)) * (has ? has->to_SI / UnitOf(sought).to_SI : 1.0) > sought.most;
}

bool CanBe(const Column& column, const Sought& sought, const Track& track) {
  constexpr double kSeldom = 0.25;
  if (sought.kind == "turn") return IsTurn(column);
  if (sought.kind == "pulse") return IsPulse(column);
  if (sought.kind == "column" && !column.IsNumber()) return UnitOf(sought).dimension == Dimension::kPure;
  if (!column.IsNumber() || !UnitFits(column, sought, track) || IsTooLarge(column, sought)) return false;
  if (sought.kind == "value") return ShareOfChanges(column) > kSeldom;
  return sought.kind == "any" || sought.kind == "column" || ShareOfChanges(column) <= kSeldom;
}

/// "{}" is the value that was taken.
std::string NoteWith(std::string note, const std::vector<double>& values) {
  const std::size_t at = note.find("{}");
  return at == std::string::npos || values.empty() ? note
                                                   : note.replace(at, 2, fmt::format("{:.6g}", values.front()));
}

/// The quantities of one track, found one after the other.
class Seeker {
 public:
  Seeker(const std::vector<Sought>& all, Track& track) : all_(all), track_(track) {}

  /// Takes those that have a column or a line.
  /// @param on_circle  Columns that are known by where they go.
  void Find(const std::map<std::string, std::string>& on_circle = {}) {
    found_.clear();
    taken_.clear();
    source_.clear();
    assumed_.clear();
    for (const auto& [name, column] : on_circle) taken_.insert(column);
    for (const Sought& sought : all_) {
      if (const auto known = on_circle.find(sought.name); known != on_circle.end()) {
        const Column& column = *std::ranges::find(track_.columns, known->second, &Column::name);
        source_[sought.name] = column.name;
        Put(sought, InUnitOf(sought, column), column.unit);
        continue;
      }
      if (const Column* column = ColumnFor(sought)) {
        taken_.insert(column->name);
        source_[sought.name] = column->name;
        Put(sought, InUnitOf(sought, *column), column->unit);
      } else if (const std::vector<double> stated = StatedOf(sought); !stated.empty()) {
        Put(sought, stated, "");
      }
    }
  }

  /// Makes what is left of others, or of itself.
  void Make(std::vector<std::string>& remarks) {
    for (bool more = true; more;) {
      more = false;
      for (const Sought& sought : all_) {
        const std::string* formula = Has(sought) ? nullptr : FormulaOf(sought);
        if (!formula) continue;
        const std::vector<double> values = Evaluated(*formula);
        const bool is_said = !sought.note.empty() && !values.empty() && !std::isnan(values.front());
        if (is_said) remarks.push_back(NoteWith(sought.note, values));
        Put(sought, values, "");
        more = true;
      }
    }
  }

  bool Has(const Sought& sought) const {
    return std::ranges::find(found_, sought.name, &Column::name) != found_.end();
  }

  bool HasColumn(const std::string& name) const { return std::ranges::find(found_, name, &Column::name) != found_.end(); }

  std::string SourceOf(const std::string& name) const { return source_.contains(name) ? source_.at(name) : ""; }

  /// Columns in a unit of what is read that nothing was made of, by what the file calls them.
  std::vector<std::string> LeftOver(const Map& map) const {
    std::set<Dimension> read;
    for (const Sought& sought : all_)
      if (sought.kind == "value" && HasColumn(sought.name)) read.insert(UnitOf(sought).dimension);
    std::vector<std::string> left;
    for (const Column& column : track_.columns) {
      const auto unit = UnitNamed(column.unit);
      const auto is_in = [&column](const MappedColumn& c) {
        const std::vector<std::string> names = Expression(c.expression, c.where).Names();
        return c.expression == column.name || std::ranges::count(names, column.name) > 0;
      };
      if (column.IsNumber() && unit && read.contains(unit->dimension) && !taken_.contains(column.name) && std::ranges::none_of(map.columns, is_in))
        left.push_back(fmt::format("\"{}\"", column.name));
    }
    return left;
  }

  /// In a column, with a unit that says what it is; what has no unit needs none, nor does an angle, but for one in arcsec beside
  /// one other quantity alone, which is none that is called an error.
  bool HasSurely(const std::string& name, bool is_of_two) const {
    const auto found = std::ranges::find(found_, name, &Column::name);
    const auto unit = UnitAtEnd(name);
    if (found == found_.end()) return false;
    if (is_of_two && unit && unit->name == "arcsec") return UnitNamed(found->unit) && !IsCalledError(SourceOf(name));
    return !unit || unit->dimension == Dimension::kAngle || UnitNamed(found->unit);
  }

  /// What it needs and no column has is made of others.
  bool GivesANumber(const std::string& text) {
    const Expression expression(text, text);
    for (const Sought& sought : all_) {
      const bool is_needed = std::ranges::count(expression.Names(), sought.name) > 0 && !Has(sought);
      if (const std::string* formula = is_needed ? FormulaOf(sought) : nullptr) Put(sought, Evaluated(*formula), "");
    }
    return std::isfinite(Evaluated(text).front());
  }

  /// The columns of the track under the names that formulas have.
  void Finish() {
    for (Column& column : found_) {
      for (Column& own : track_.columns) {
        if (own.name == column.name) own.name += " of the file";
      }
      const auto unit = UnitAtEnd(column.name);
      column.unit = unit ? std::string(unit->name) : "";
    }
    std::ranges::move(found_, std::back_inserter(track_.columns));
  }

  double First(const std::string& name) const {
    const auto found = std::ranges::find(found_, name, &Column::name);
    return found == found_.end() || found->value.empty() ? kNaN : found->value.front();
  }
  std::vector<double> Distinct(const std::string& name) const {
    const auto found = std::ranges::find(found_, name, &Column::name);
    if (found == found_.end()) return {};
    const std::set<double> distinct(found->value.begin(), found->value.end());
    return {distinct.begin(), distinct.end()};
  }
  const std::vector<std::string>& assumed() const { return assumed_; }

 private:
  const Column* ColumnFor(const Sought& sought) const {
    const Column* best = nullptr;
    int clearness = 0;
    for (const Column& column : track_.columns) {
      const int own =
          taken_.contains(column.name) || !CanBe(column, sought, track_) ? 0 : ClearnessBy(column.name, sought.words);
      if (own <= clearness) continue;
      clearness = own;
      best = &column;
    }
    return best;
  }

  std::vector<double> StatedOf(const Sought& sought) const {
    if (sought.words.empty() || sought.kind == "value" || sought.kind == "column" || sought.kind == "pulse") return {};
    return sought.kind == "turn" ? StatedTurns(track_) : StatedValues(track_, sought.words, UnitOf(sought));
  }

  /// Angles without a unit that stay within a turn of rad. A shaft before a gear goes on for many turns where the one behind it does; of axes
  /// beside each other one may be tilted by a few degrees only.
  bool AreInRad(const Sought& sought, const Column& column) const {
    constexpr double kMoreThanATurn_rad = 6.4;
    const auto stays = [](const Column& c) {
      return c.value.size() > 20 && std::ranges::all_of(c.value, [](double x) { return !(std::abs(x) > kMoreThanATurn_rad); });
    };
    std::vector<bool> all = {stays(column)};
    for (const Sought& other : all_) {
      const auto unit = UnitAtEnd(other.name);
      if (&other == &sought || other.kind != sought.kind || !unit || unit->name != "deg") continue;
      const auto found = source_.find(other.name);
      const Column* beside = found == source_.end() ? ColumnFor(other) : &*std::ranges::find(track_.columns, found->second, &Column::name);
      if (beside && beside != &column && IsNoUnit(beside->unit) && beside->IsNumber()) all.push_back(stays(*beside));
    }
    return sought.kind == "value" ? std::ranges::count(all, true) > 0 : std::ranges::count(all, false) == 0;
  }

  /// A column that says no unit is in that of the name; a place that stays within a turn of rad, in rad.
  std::vector<double> InUnitOf(const Sought& sought, const Column& column) {
    const NamedUnit to = UnitOf(sought);
    auto has = UnitNamed(column.unit);
    const auto counts = has || to.dimension != Dimension::kAngle ? std::nullopt : CountsPerTurnOf(column, track_, sought.words);
    if (counts) {
      assumed_.push_back(fmt::format("\"{}\" is in counts, {:.10g} per turn as the file states", column.name, *counts));
      has = NamedUnit{"counts", Dimension::kAngle, units::turn / *counts};
    }
    if (!has && to.dimension != Dimension::kPure) {
      has = to.name == "deg" && AreInRad(sought, column) ? UnitNamed("rad") : to;
      assumed_.push_back(fmt::format("the unit of \"{}\" is not said and taken as {}", column.name, has->name));
    }
    std::vector<double> values = column.value;
    for (double& x : values) x *= has ? has->to_SI / to.to_SI : 1.0;
    return values;
  }

  void Put(const Sought& sought, std::vector<double> values, const std::string& unit) {
    found_.push_back({sought.name, unit, std::move(values), {}});
  }

  /// What is sought is what was found of it, not a column that is called so.
  const std::vector<double>* ValuesOf(const std::string& name) const {
    if (name == "time_s" && track_.HasClock()) return &track_.time_s;
    const bool is_sought = std::ranges::find(all_, name, &Sought::name) != all_.end();
    for (const std::vector<Column>* columns : {&found_, static_cast<const std::vector<Column>*>(&track_.columns)}) {
      if (is_sought && columns != &found_) break;
      const auto found = std::ranges::find(*columns, name, &Column::name);
      if (found != columns->end() && found->IsNumber()) return &found->value;
    }
    return nullptr;
  }

  /// The first formula that can be made of what is there.
  const std::string* FormulaOf(const Sought& sought) const {
    for (const std::string& formula : sought.otherwise) {
      if (ValuesOf(formula)) return &formula;
      const Expression expression(formula, sought.name);
      if (std::ranges::all_of(expression.Names(),
                              [this](const std::string& name) { return ValuesOf(name) != nullptr; }))
        return &formula;
    }
    return nullptr;
  }

  std::vector<double> Evaluated(const std::string& formula) const {
    if (const auto* values = ValuesOf(formula)) return *values;
    return Expression(formula, formula).Evaluate(track_.Rows(), [this](const std::string& name) {
      return Values{*ValuesOf(name), nullptr};
    });
  }

  const std::vector<Sought>& all_;
  Track& track_;
  std::vector<Column> found_;
  std::set<std::string> taken_;  // columns of the file
  std::map<std::string, std::string> source_;  // the file's name of each quantity
  std::vector<std::string> assumed_;
};

std::vector<std::string> NamesIn(const std::string& list) {
  std::vector<std::string> names;
  for (std::string_view rest = list; !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    names.emplace_back(Trimmed(rest.substr(0, comma)));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return names;
}

/// Finds by names first; then by a circle that columns go round.
void FindIn(const Map& map, Track& track, Seeker& seeker, std::vector<std::string>& remarks) {
  const auto is_missing = [&seeker](const Sought& sought) { return sought.kind == "value" && sought.otherwise.empty() && !seeker.Has(sought); };
  seeker.Find();
  if (std::ranges::none_of(map.sought, is_missing)) return;
  const std::map<std::string, std::string> on_circle = ColumnsOnCircle(map, track, remarks);
  if (!on_circle.empty()) seeker.Find(on_circle);
}

/// The most columns by which a track is of the map's kind; 0: it is not.
/// @param by_names  Whether columns need no units, as many of them do not anyway.
std::size_t ColumnsOfKind(const Track& own, const Map& map, bool by_names) {
  constexpr std::size_t kSayEnough = 6;  // names that are all there are of nothing else
  if (map.guess_clock == "none" && own.HasClock()) return 0;
  Track track = own;
  TakeAnglesOfProbes(track);
  StackTurns(map, track);
  StackBalls(map, track);
  Seeker seeker(map.sought, track);
  std::vector<std::string> unsaid;
  FindIn(map, track, seeker, unsaid);
  std::size_t most = 0;
  for (const std::string& list : map.guess_by) {
    const std::vector<std::string> names = NamesIn(list);
    const bool needs_no_units = by_names || names.size() >= kSayEnough;
    if (std::ranges::all_of(names, [&](const std::string& name) {
          return needs_no_units ? seeker.HasColumn(name) : seeker.HasSurely(name, names.size() == 2);
        }))
      most = std::max(most, names.size());
  }
  return map.guess_only.empty() || most == 0 || seeker.GivesANumber(map.guess_only) ? most : 0;
}

std::size_t ColumnsOfKind(const Recording& recording, const Map& map, bool by_names = false) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const Track& track : recording.tracks) fewest = std::min(fewest, ColumnsOfKind(track, map, by_names));
  return fewest;
}

/// Of a map that seeks nothing: every name in its formulas is one of a column or of a number that the file states, columns most.
bool HasAllNamesOf(const Map& map, const Recording& recording) {
  constexpr std::size_t kFewestColumns = 3;  // two have names that anybody gives
  std::set<std::string> columns, numbers;
  for (const Track& track : recording.tracks) {
    for (const Column& column : track.columns) columns.insert(column.name);
    for (const auto& [name, number] : track.numbers) numbers.insert(name);
  }
  std::set<std::string> found;
  for (const MappedColumn& column : map.columns) {
    const Expression formula(column.expression, column.where);
    for (const std::string& name : formula.Names()) {
      if (columns.contains(name)) found.insert(name);
      const bool is_made = name == "time_s" || (name == "moved" && !map.file.moved_by.empty());
      if (!columns.contains(name) && !numbers.contains(name) && !is_made) return false;
    }
  }
  return found.size() >= kFewestColumns;
}

/// "{radius_mm}" is its first value, "{radius_mm...}" all there are.
void FillInKey(const Seeker& seeker, const Sought& sought, std::string& key) {
  const auto replace = [&key](const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = key.find(what, at)) != std::string::npos; at += by.size())
      key.replace(at, what.size(), by);
  };
  std::string all;
  for (const double value : seeker.Distinct(sought.name))
    all += fmt::format("{}{}", all.empty() ? "" : ", ", value);
  replace("{" + sought.name + "...}", all);
  replace("{" + sought.name + "}", fmt::format("{}", seeker.First(sought.name)));
}

[[noreturn]] void RefuseWithout(const Sought& sought, const Recording& recording) {
  const std::string called = sought.words.empty() ? sought.name : sought.words.front();
  throw InputError(
      recording.file,
      fmt::format("no column is {} by its name and unit; there are {}", called, ColumnNames({recording})),
      fmt::format("a name such as \"{}\", or --column '{}=a column'", called, sought.name));
}

/// A circle's axes are called x and y whatever its plane is.
void SayPlane(const Map& map, const Track& track, const Seeker& seeker, Recording& recording) {
  if (std::ranges::find(map.sought, "radius_mm", &Sought::name) == map.sought.end()) return;
  const auto plane = PlaneOf(track, seeker.SourceOf("commanded_1_mm"), seeker.SourceOf("commanded_2_mm"), recording.file);
  if (plane && *plane != "XY")
    recording.remarks.push_back(fmt::format("the circle is in the plane {}: x of the results is {}, y is {}", *plane, plane->front(), plane->back()));
}

/// What the map makes of a quantity that is not there.
void DropWithout(const Sought& sought, Map& map) {
  std::erase_if(map.columns, [&sought](const MappedColumn& c) {
    const std::vector<std::string> names = Expression(c.expression, c.where).Names();
    return std::ranges::count(names, sought.name) > 0;
  });
}

/// What was made only to tell of which kind a file is.
void DropOfKind(const Map& map, Track& track) {
  if (map.guess_only.empty()) return;
  const auto is_in = [](const std::string& name, const std::string& formula, const std::string& where) {
    const std::vector<std::string> names = Expression(formula, where).Names();
    return std::ranges::count(names, name) > 0;
  };
  for (const Sought& sought : map.sought) {
    const bool is_needed = !sought.words.empty() || !is_in(sought.name, map.guess_only, "only") ||
                           std::ranges::any_of(map.columns, [&](const MappedColumn& c) { return is_in(sought.name, c.expression, c.where); });
    if (!is_needed) std::erase_if(track.columns, [&sought](const Column& c) { return c.name == sought.name; });
  }
}

}  // namespace

std::optional<Map> ReadyMapByBegin(const std::string& text) {
  for (const Map& map : ReadyMaps()) {
    if (!map.guess_begins.empty() && text.starts_with(map.guess_begins)) return map;
  }
  return std::nullopt;
}

std::optional<Map> ReadyMapOf(const Recording& recording) {
  if (recording.tracks.empty()) return std::nullopt;
  const Map* best = nullptr;
  std::size_t most = 0;
  for (const Map& map : ReadyMaps()) {
    const std::size_t columns = ColumnsOfKind(recording, map);
    if (columns <= most) continue;
    most = columns;
    best = &map;
  }
  return best ? std::optional(*best) : std::nullopt;
}

std::string ReadyMapsByNames(const Recording& recording) {
  std::string maps;
  for (const Map& map : ReadyMaps()) {
    if (map.sought.empty() && HasAllNamesOf(map, recording)) maps += fmt::format("; of a {}: --map {}", map.title, map.name);
    if (!map.guess_by.empty() && ColumnsOfKind(recording, map, true) > 2)
      maps += fmt::format("; of a {}: --map {}, with units in the names if they are not those of the map", map.title, map.name);
  }
  return maps;
}

void TakeSought(Map& map, Recording& recording) {
  if (map.sought.empty()) return;
  for (Track& track : recording.tracks) {
    const bool has_probes = std::ranges::find(map.sought, "probe_1_um", &Sought::name) != map.sought.end();
    const std::vector<double> angles_deg = has_probes ? TakeAnglesOfProbes(track) : std::vector<double>();
    if (!angles_deg.empty()) map.set.push_back(fmt::format("probes.angles_deg=[{}]", fmt::join(angles_deg, ", ")));
    StackTurns(map, track);
    StackBalls(map, track);
    Seeker seeker(map.sought, track);
    FindIn(map, track, seeker, recording.remarks);
    SayPlane(map, track, seeker, recording);
    if (const std::vector<std::string> left = seeker.LeftOver(map); !left.empty())
      recording.remarks.push_back(fmt::format("left out, for by {} nothing of this map is meant: {}", left.size() > 1 ? "their names" : "its name", fmt::join(left, ", ")));
    for (const std::string& assumed : seeker.assumed()) recording.remarks.push_back(assumed);
    seeker.Make(recording.remarks);
    for (const Sought& sought : map.sought) {
      if (!seeker.Has(sought) && sought.kind == "value") RefuseWithout(sought, recording);
      if (!seeker.Has(sought)) DropWithout(sought, map);
      if (!seeker.Has(sought)) std::erase_if(map.set, [&sought](const std::string& key) { return key.find("{" + sought.name) != std::string::npos; });
      for (std::string& key : map.set) FillInKey(seeker, sought, key);
    }
    seeker.Finish();
    DropOfKind(map, track);
    PlaceClampings(map, recording, track);
  }
}

}  // namespace twinbench::imports
