#include "twin/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/reading_clock.h"
#include "twin/core/units.h"
#include "twin/import/blocks.h"
#include "twin/import/course.h"
#include "twin/import/follows.h"
#include "twin/import/guess.h"
#include "twin/import/join.h"
#include "twin/import/source.h"
#include "twin/import/unnamed_clock.h"

namespace twinbench::imports {
namespace {

constexpr double kLikeOne = 0.2;     // a gain further from 1 is no error of a scale but another quantity
constexpr double kFollows = 0.5;     // correlation below which a device does not follow at all
constexpr std::size_t kFewest = 12;  // readings that are worth a diagnosis ...
constexpr std::size_t kFewestCompared = 3;  // ... and where two quantities are compared

const ReadingColumn* ColumnOf(const BenchFormat& bench, const std::string& name) {
  const auto found = std::ranges::find(bench.columns, name, &ReadingColumn::name);
  return found == bench.columns.end() ? nullptr : &*found;
}

/// Without a row that lacks a needed value or a time, or whose time goes back.
class Rows {
 public:
  Rows(const Session& session, const BenchFormat& bench) : session_(session), bench_(bench) {}

  Session Whole(std::vector<LeftOut>& left_out) const {
    std::vector<std::size_t> kept;
    std::size_t without = 0, back = 0;
    double last_s = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < session_.Rows(); ++i) {
      if (!HasAll(i)) {
        ++without;
      } else if (!(session_.time_s[i] > last_s || (session_.time_s[i] == last_s && !session_.has_clock))) {
        ++back;
      } else {
        kept.push_back(i);
        last_s = session_.time_s[i];
      }
    }
    if (without > 0) left_out.push_back({without, "rows without a time or a value that is needed"});
    if (back > 0) left_out.push_back({back, "rows whose time does not go on"});
    return Choose(kept);
  }

 private:
  bool HasAll(std::size_t i) const {
    if (!std::isfinite(session_.time_s[i])) return false;
    return std::ranges::all_of(session_.value, [&](const auto& entry) {
      const ReadingColumn* column = ColumnOf(bench_, entry.first);
      return !column || !column->MustBeThere() || std::isfinite(entry.second[i]);
    });
  }
  Session Choose(const std::vector<std::size_t>& kept) const {
    Session whole{session_.name, session_.has_clock, {}, {}};
    for (const std::size_t i : kept) whole.time_s.push_back(session_.time_s[i]);
    for (const auto& [name, values] : session_.value) {
      for (const std::size_t i : kept) whole.value[name].push_back(values[i]);
    }
    return whole;
  }

  const Session& session_;
  const BenchFormat& bench_;
};

double MeanOf(const std::vector<double>& values, const Block& block) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = block.begin; i < block.end; ++i) {
    if (!std::isfinite(values[i])) continue;
    sum += values[i];
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

/// What is said of a whole run at the end.
struct Tally {
  std::vector<LeftOut> left_out;
  int wraps = 0, reversals = 0, rests = 0, fly_backs = 0;
  std::size_t rows = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low, fastest = 0.0, rest_share = 0.0, widest = 0.0;
  bool stops = true;
  std::size_t usual_rows = 1;
};

/// Makes the readings of one set-up after the other.
class Maker {
 public:
  Maker(const BenchFormat& bench, const Map& map, bool linear) : bench_(bench), map_(map), linear_(linear) {}

  void Take(const Session& session, std::size_t most, Imported& imported) {
    if (session.Rows() < 2) return;
    const std::string& by = CourseColumn(session);
    const std::vector<double>& reference = session.value.at(by);
    const double wrap = FindWrap(reference, map_.course, linear_);
    const std::vector<double> no_clock;
    const bool one_place = bench_.compared && IsOnePlace(session);
    Course course = CourseOf(reference, session.has_clock && !one_place ? session.time_s : no_clock, map_.course, wrap);
    if (one_place) NumberApproaches(session.value.at("direction"), course);
    if (bench_.compared) CheckFollowing(session, course.reference, one_place);
    const Blocks cut = CutIntoBlocks(course, session.time_s, most, RestsIn(session, course));
    Count(session, course, cut);
    if (course.stop_and_go) {
      TakeStops(session, course, cut, imported);
    } else {
      for (const Block& block : cut.blocks)
        Append(session, course, block, {block.begin, MeanOf(course.reference, block)}, imported);
    }
    ++setup_;
    first_pass_ = last_pass_ + 1;
  }

  Tally tally;

 private:
  /// Of a drive from stop to stop; empty: of another.
  std::vector<Rest> RestsIn(const Session& session, const Course& course) const {
    if (!course.stop_and_go) return {};
    const std::vector<double> none;
    const std::vector<Rest> rests =
        RestsOf(course, bench_.compared ? session.value.at(bench_.compared->shown) : none, linear_ ? 0.0 : units::turn);
    const auto arrived = std::ranges::count(rests, true, &Rest::arrives);
    if (bench_.compared && arrived < static_cast<std::ptrdiff_t>(kFewestCompared))
      throw InputError(NameOf(bench_.compared->shown),
                       fmt::format("the device arrives in {} of the {} rests of {} only", arrived, rests.size(), bench_.compared->reference),
                       "longer rests; or [course] kind = \"sweep\" in a map, to take it as motion");
    return rests;
  }

  /// By what the course is told: the reference of a bench that compares, else the first column there is.
  std::string CourseColumn(const Session& session) const {
    if (bench_.compared) return bench_.compared->reference;
    for (const ReadingColumn& column : bench_.columns) {
      if (column.role == ColumnRole::kRequired && session.value.contains(column.name) && UnitAtEnd(column.name))
        return column.name;
    }
    return session.value.begin()->first;
  }

  /// The reference stands still, and every row says from which side the axis came to it.
  bool IsOnePlace(const Session& session) const {
    const auto [low, high] = std::ranges::minmax(session.value.at(bench_.compared->reference));
    const auto direction = session.value.find("direction");
    if (low != high || direction == session.value.end()) return false;
    const auto comes = [&direction](double from) { return std::ranges::find(direction->second, from) != direction->second.end(); };
    return comes(1.0) && comes(-1.0);
  }
  /// Every change of the side begins a pass.
  static void NumberApproaches(const std::vector<double>& direction, Course& course) {
    for (std::size_t i = 1; i < direction.size(); ++i) {
      const bool turned = direction[i] != direction[i - 1];
      course.reversals += turned ? 1 : 0;
      course.pass[i] = course.pass[i - 1] + (turned ? 1 : 0);
    }
  }

  void CheckFollowing(const Session& session, const std::vector<double>& reference, bool one_place) const {
    const std::string& name = bench_.compared->shown;
    const std::vector<double>& shown = session.value.at(name);
    const auto [low, high] = std::ranges::minmax(shown);
    const std::string source = NameOf(name);
    if (low == high)
      throw InputError(source, fmt::format("{} is {:g} in all {} rows: the channel is dead", name, low / UnitAtEnd(name)->to_SI, shown.size()),
                       "another column");
    if (one_place) return;
    const auto [first, last] = std::ranges::minmax(reference);
    if (first == last)
      throw InputError(NameOf(bench_.compared->reference), "the reference never moves",
                       "another column; for one place from both sides a column \"direction\" of 1 and -1");
    const Following following = FollowingOf(reference, shown);
    const bool one_to_one = std::abs(following.gain - 1.0) <= kLikeOne;
    if (one_to_one && following.correlation > kFollows) return;
    if (std::abs(following.correlation) < kFollows)
      throw InputError(source,
                       fmt::format("{} does not follow {} (correlation {:.2f})", name, bench_.compared->reference,
                                   following.correlation),
                       "columns of the same axis; of an error use " + Sum());
    const std::string meaning = MeaningOfGain(following.gain);
    throw InputError(
        source,
        fmt::format("{} follows {} times {:.6g}{}", name, bench_.compared->reference, following.gain,
                    meaning.empty() ? "" : ": " + meaning),
        std::abs(following.gain + 1.0) <= kLikeOne
            ? fmt::format("the same sense: {} = \"-{}\"", KeyOf(name), ExpressionOf(name))
            : fmt::format("the same unit and sense: {} = \"...\" in the unit it has, or {} = \"{} / {:.6g}\"",
                          KeysOf(name), KeyOf(name), ExpressionOf(name), following.gain));
  }
  std::string Sum() const {
    return fmt::format("{} = \"[reference column] + [error column]\"", bench_.compared->shown);
  }
  static std::string KeysOf(const std::string& column) {
    return BaseOf(column) + "_rad, " + BaseOf(column) + "_arcsec or " + BaseOf(column) + "_mm";
  }
  /// What a column came from, to be used inside a formula.
  std::string ExpressionOf(const std::string& column) const {
    for (const MappedColumn& mapped : map_.columns) {
      if (mapped.column != column) continue;
      const bool is_name = mapped.expression.find_first_of("+*/()[]") == std::string::npos;
      return is_name ? "[" + mapped.expression + "]" : "(" + mapped.expression + ")";
    }
    return column;
  }
  /// The key with the unit that counted.
  std::string KeyOf(const std::string& column) const {
    for (const MappedColumn& mapped : map_.columns) {
      if (mapped.column == column && !mapped.unit.empty()) return BaseOf(column) + "_" + mapped.unit;
    }
    return column;
  }
  std::string NameOf(const std::string& column) const {
    for (const MappedColumn& mapped : map_.columns) {
      if (mapped.column == column) return mapped.where.empty() ? "\"" + mapped.expression + "\"" : mapped.where;
    }
    return column;
  }

  void Count(const Session& session, const Course& course, const Blocks& cut) {
    tally.rows += session.Rows();
    tally.wraps += course.wraps;
    tally.reversals += course.reversals;
    tally.rests += course.rests;
    tally.fly_backs += course.fly_backs;
    tally.low = std::min(tally.low, std::ranges::min(course.reference));
    tally.high = std::max(tally.high, std::ranges::max(course.reference));
    tally.fastest = std::max(tally.fastest, course.fastest);
    tally.rest_share = std::max(tally.rest_share, course.rest_share);
    tally.widest = std::max(tally.widest, cut.widest);
    tally.usual_rows = std::max(tally.usual_rows, cut.usual_rows);
    tally.stops = tally.stops && (course.stops || course.stop_and_go);
    if (cut.left_out > 0) tally.left_out.push_back({cut.left_out, "rows on the way between measuring positions"});
    std::size_t settling = 0;
    for (std::size_t k = 0; course.stop_and_go && k < cut.blocks.size(); ++k)
      settling += k > 0 && cut.blocks[k].rest == cut.blocks[k - 1].rest ? 0 : cut.blocks[k].begin - cut.blocks[k].rest;
    if (settling > 0) tally.left_out.push_back({settling, "rows at the beginning of rests, before the device stood"});
    if (cut.moving > 0)
      tally.left_out.push_back({cut.moving, fmt::format("rows of {} rests of the command at whose end the device was still on its way", cut.moving_rests)});
  }

  /// Every rest is a reading; the senses are those from rest to rest.
  void TakeStops(const Session& session, const Course& course, const Blocks& cut, Imported& imported) {
    std::vector<double> places;
    for (const Block& block : cut.blocks) places.push_back(MeanOf(course.reference, block));
    CourseSettings stops;
    stops.kind = "stops";
    const Course from_stop_to_stop = CourseOf(places, {}, stops, 0.0);
    for (std::size_t k = 0; k < cut.blocks.size(); ++k) {
      Reading& reading = Append(session, from_stop_to_stop, cut.blocks[k], {k, places[k]}, imported);
      if (ColumnOf(bench_, "dwell_s"))
        reading.dwell_s = session.time_s[cut.blocks[k].begin] - session.time_s[cut.blocks[k].rest];
    }
  }

  /// Where a reading stands in the course: which entry, at which angle.
  struct Place {
    std::size_t at = 0;
    double reference = 0.0;
  };

  Reading& Append(const Session& session, const Course& course, const Block& block, const Place& place,
                  Imported& imported) {
    Reading reading;
    const std::size_t at = place.at;
    reading.reading = static_cast<int>(imported.readings.size());
    reading.time = Time(FromSeconds(MeanOf(session.time_s, block)));
    reading.setup = setup_;
    reading.pass = first_pass_ + course.pass[at];
    reading.direction = course.direction[at];
    if (reading.pass != last_pass_) position_ = 0;
    last_pass_ = reading.pass;
    reading.position = position_++;
    if (block.end - block.begin > 1) reading.n_samples = static_cast<int>(block.end - block.begin);
    for (const auto& [name, values] : session.value) Fill(name, values, block, reading);
    if (bench_.compared) ColumnOf(bench_, bench_.compared->reference)->number(reading) = place.reference;
    if (bench_.compared && !course.stops && std::isfinite(course.velocity[at]))
      ColumnOf(bench_, bench_.compared->velocity)->number(reading) = MeanOf(course.velocity, block);
    reading.extra["motion"] = MotionName(course.motion[at]);
    if (!session.has_clock) reading.extra[kClockColumn] = kNoClock;
    imported.readings.push_back(std::move(reading));
    return imported.readings.back();
  }

  /// Numbers are means, labels are the first row's.
  void Fill(const std::string& name, const std::vector<double>& values, const Block& block,
            Reading& reading) const {
    const ReadingColumn* column = ColumnOf(bench_, name);
    if (column && column->number) {
      column->number(reading) = MeanAngle(name, values, block);
      return;
    }
    const double value = values[block.begin];
    if (!std::isfinite(value)) return;
    const std::string text = fmt::format("{}", std::lround(value));
    if (column && !column->parse(reading, text))
      throw InputError(NameOf(name), fmt::format("{} is {}", name, text), column->expected);
  }

  /// Of a device that starts again at a turn: rows of a block are taken together by the nearest way.
  double MeanAngle(const std::string& name, const std::vector<double>& values, const Block& block) const {
    if (!bench_.compared || name != bench_.compared->shown || linear_) return MeanOf(values, block);
    const double first = values[block.begin];
    double sum = 0.0;
    for (std::size_t i = block.begin; i < block.end; ++i) sum += std::remainder(values[i] - first, units::turn);
    return first + sum / static_cast<double>(block.end - block.begin);
  }

  const BenchFormat& bench_;
  const Map& map_;
  bool linear_;
  int setup_ = 0, first_pass_ = 0, last_pass_ = -1, position_ = 0;
};

/// Stops of the same angle get the same position, however often they were visited.
void NumberPositions(std::vector<Reading>& readings, const ReadingColumn& reference) {
  std::vector<double> places;
  for (Reading& reading : readings) places.push_back(reference.number(reading));
  std::vector<double> sorted = places;
  std::ranges::sort(sorted);
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] - sorted[i - 1] > 1e-9) steps.push_back(sorted[i] - sorted[i - 1]);
  }
  if (steps.empty()) {
    for (Reading& reading : readings) reading.position = 0;
    return;
  }
  const double largest = std::ranges::max(steps);
  std::erase_if(steps, [largest](double step) { return step < 0.05 * largest; });  // within a stop
  const double same = 0.25 * std::ranges::min(steps);
  std::vector<double> stops;
  for (const double place : sorted) {
    if (stops.empty() || place - stops.back() > same) stops.push_back(place);
  }
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto above = std::ranges::upper_bound(stops, places[i]);
    readings[i].position = static_cast<int>(above - stops.begin()) - 1;
  }
}

std::string InUnit(double rad, bool linear, double turn_m) {
  if (linear) return fmt::format("{:.6g} mm", rad / units::turn * turn_m / units::mm);
  return fmt::format("{:.6g} deg", rad / units::deg);
}

std::string StoryOf(const std::vector<Recording>& recordings, const Joined& joined, const Tally& tally,
                    const std::vector<std::string>& guessed, const Map& map, const Imported& imported) {
  std::string text;
  for (const Recording& recording : recordings)
    text += fmt::format("{}: {}\n", recording.file, recording.layout) + RemarksOn(recording);
  for (const MappedColumn& column : map.columns) {
    const std::string& unit = joined.unit.at(column.column);
    text += fmt::format("  {} <- {}{}\n", BaseOf(column.column), column.expression,
                        unit.empty() ? "" : " [" + unit + "]");
  }
  const auto unit = [&](double rad) { return InUnit(rad, joined.linear, joined.turn_m); };
  text += tally.low == tally.high
              ? fmt::format("the reference stands at {}, reached from both sides", unit(tally.low))
              : fmt::format("the reference goes from {} to {} ({:.4g} turns)", unit(tally.low), unit(tally.high),
                            (tally.high - tally.low) / units::turn);
  text += fmt::format(", {} reversals, {} fly-backs, {} rests", tally.reversals, tally.fly_backs, tally.rests);
  if (tally.fastest > 0.0)
    text += fmt::format(", usual top speed {}/s, at rest {:.1f} % of the rows", unit(tally.fastest),
                        100.0 * tally.rest_share);
  text += "\n";
  if (tally.wraps > 0) text += fmt::format("the reference starts again {} times: it was unwrapped\n", tally.wraps);
  text += tally.stops ? "taken as stops: every row, or every rest, is a reading at rest (course.kind)\n"
                      : "taken as motion that is read while it goes on (course.kind)\n";
  text += HasClock(imported.readings) ? ClockText(recordings[0].tracks[0]) + "\n"
                                      : "no clock: the rows are in order, and no duration or rate is known\n";
  if (tally.widest > 0.0)
    text += fmt::format(
        "averaged in blocks of up to {} rows, never across a reversal, a rest or a gap: orders up to {} keep 99 "
        "%, largest and smallest values of single rows are lost\n",
        tally.usual_rows, HighestOrderKept(tally.widest));
  for (const auto* list : {&joined.left_out, &tally.left_out}) {
    for (const LeftOut& left_out : *list) text += fmt::format("left out: {} {}\n", left_out.count, left_out.why);
  }
  for (const auto* list : {&guessed, &joined.remarks}) {
    for (const std::string& remark : *list) text += "note: " + remark + "\n";
  }
  return text + fmt::format("{} readings of {} rows, {} mounting{}, bench {}\n", imported.readings.size(), tally.rows, joined.sessions.size(),
                            joined.sessions.size() == 1 ? "" : "s", imported.bench);
}

void RequireColumns(const BenchFormat& bench, const Map& map, const std::vector<Recording>& recordings) {
  std::string missing;
  for (const ReadingColumn& column : bench.columns) {
    if (!column.MustBeThere() || !column.number) continue;
    const bool given =
        std::ranges::any_of(map.columns, [&column](const MappedColumn& c) { return c.column == column.name; });
    if (!given) missing += (missing.empty() ? "" : ", ") + column.name;
  }
  if (!missing.empty())
    throw InputError(recordings[0].file,
                     fmt::format("nothing is said about {}; there are {}", missing, ColumnNames(recordings)),
                     "a line for each under [columns] of a map");
}

/// ", 38 rows ... were left out" for a message.
std::string CostOf(const std::vector<LeftOut>& left_out) {
  std::string cost;
  for (const LeftOut& entry : left_out) cost += fmt::format("{} {} {}", cost.empty() ? "; left out are" : ",", entry.count, entry.why);
  return cost;
}

std::vector<Recording> ReadAll(const std::vector<std::string>& files, const Map& map) {
  std::vector<Recording> recordings;
  Layout layout = map.file;
  layout.columns_are_open = map.columns.empty() && map.bench.empty();
  for (const std::string& file : files) {
    recordings.push_back(ReadRecording(file, layout, map.clock));
    TakeUnnamedClock(map, recordings.back());
  }
  return recordings;
}

std::vector<std::string> ComparedColumns(const BenchFormat& bench) {
  if (!bench.compared) return {};
  return {bench.compared->reference, bench.compared->shown};
}

/// Labels that the map gives take the place of those that were derived; they are in the readings already.
bool Gives(const Map& map, const std::string& column) {
  return std::ranges::any_of(map.columns, [&column](const MappedColumn& c) { return c.column == column; });
}

/// Means in blocks lower a largest value and raise a smallest one, which are results of a circle: who wants them says so.
std::size_t MostReadings(const BenchFormat& bench, const Map& map) {
  constexpr std::size_t kCompared = 5000;
  if (map.average.most_readings > 0) return static_cast<std::size_t>(map.average.most_readings);
  return bench.compared ? kCompared : std::numeric_limits<std::size_t>::max();
}

Imported MakeReadings(const std::vector<Recording>& recordings, Map map) {
  std::vector<std::string> guessed;
  TakeReadyMapOfList(recordings, map, guessed);
  const BenchFormat& bench = BenchFor(recordings, map);
  FillIn(recordings, bench, ComparedColumns(bench), map, guessed);
  RequireColumns(bench, map, recordings);
  const Joined joined = Join(recordings, map, bench.compared ? bench.compared->shown : map.columns.at(0).column);
  Imported imported;
  imported.bench = bench.name;
  Maker maker(bench, map, joined.linear);
  const std::size_t most = MostReadings(bench, map) / joined.sessions.size();
  for (const Session& session : joined.sessions) {
    const Session whole = Rows(session, bench).Whole(maker.tally.left_out);
    maker.Take(whole, std::max<std::size_t>(most, kFewest), imported);
  }
  const std::size_t fewest = bench.compared ? kFewestCompared : kFewest;
  if (imported.readings.size() < fewest)
    throw InputError(recordings[0].file, fmt::format("{} readings are left{}", imported.readings.size(), CostOf(maker.tally.left_out)),
                     fmt::format("{} at least", fewest));
  if (bench.compared && maker.tally.stops && !Gives(map, "position"))
    NumberPositions(imported.readings, *ColumnOf(bench, bench.compared->reference));
  if (bench.compared)
    imported.set =
        bench.compared->scenario_of({maker.tally.stops, (maker.tally.high - maker.tally.low) / units::turn,
                                     joined.linear ? joined.turn_m : 0.0});
  for (const std::string& key : map.set) imported.set.push_back(key);
  imported.story = StoryOf(recordings, joined, maker.tally, guessed, map, imported);
  return imported;
}

}  // namespace

Imported Import(const std::vector<std::string>& files, const Map& map) {
  return MakeReadings(ReadAll(files, map), map);
}

Seen Look(const std::vector<std::string>& files, const Map& map) {
  const std::vector<Recording> recordings = ReadAll(files, map);
  Seen seen;
  for (const Recording& recording : recordings) seen.text += Describe(recording);
  try {
    seen.imported = MakeReadings(recordings, map);
    seen.text += "\nIt would be imported like this:\n" + seen.imported->story;
  } catch (const InputError& needs) {
    for (const Recording& recording : recordings) seen.text += RemarksOn(recording);
    seen.needs = needs;
  }
  return seen;
}

}  // namespace twinbench::imports
