#include "twin/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/fewest_readings.h"
#include "twin/core/units.h"
#include "twin/import/axes.h"
#include "twin/import/guess.h"
#include "twin/import/join.h"
#include "twin/import/make_readings.h"
#include "twin/import/side_by_side.h"
#include "twin/import/sought.h"
#include "twin/import/source.h"
#include "twin/import/story.h"
#include "twin/import/text.h"
#include "twin/import/unnamed_clock.h"
#include "twin/import/whole_rows.h"
#include "twin/import/wrap_gaps.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kFewestReadings = 4;  // readings of a bench that compares nothing: faces of a small polygon

/// What a bench shows is not asked for where the map gives what another instrument showed in its place.
void RequireColumns(const BenchFormat& bench, const Map& map, const std::vector<Recording>& recordings) {
  const auto is_given = [&map](const ReadingColumn& column) {
    return std::ranges::any_of(map.columns, [&column](const MappedColumn& c) { return c.column == column.name; });
  };
  const bool is_of_another = std::ranges::any_of(
      bench.columns, [&](const ReadingColumn& c) { return c.IsOfAnotherInstrument() && is_given(c); });
  std::string missing;
  for (const ReadingColumn& column : bench.columns) {
    if (!column.MustBeThere() || !column.number || (is_of_another && column.role == ColumnRole::kShown)) continue;
    if (!is_given(column)) missing += (missing.empty() ? "" : ", ") + column.name;
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

/// Where nothing was said: the ready map of whose kind the files are.
/// @return by what; empty if there is none.
std::string TakeReadyMap(const std::vector<std::string>& files, Map& map) {
  if (!map.name.empty() || !map.columns.empty() || !map.bench.empty()) return "";
  const auto by_line = ReadyMapByBegin(LoadText(files.front()));
  const auto ready = by_line ? by_line : ReadyMapOf(BeginOfTable(files.front(), map.clock));
  if (!ready) return "";
  const Map said = std::exchange(map, *ready);
  if (!said.clock.column.empty() || said.clock.rate_Hz > 0.0) map.clock = said.clock;
  map.course.axis_number = said.course.axis_number;
  map.average = said.average;
  return by_line ? "first line" : "columns";
}

/// A row a channel and a column a reading are no table of readings.
void RefuseRowsOfChannels(const Recording& recording) {
  constexpr std::size_t kWide = 200, kWider = 4;
  for (const Track& track : recording.tracks) {
    const std::size_t columns = track.columns.size(), rows = track.Rows();
    if (columns > kWide && columns > kWider * rows)
      throw InputError(recording.file, fmt::format("{} rows of {} numbers each: a row for each channel?", rows, columns),
                       "a row for each reading and a column for each channel: rows and columns exchanged");
  }
}

std::vector<Recording> ReadAll(const std::vector<std::string>& files, Map& map) {
  const std::string by = TakeReadyMap(files, map);
  std::vector<Recording> recordings;
  Layout layout = map.file;
  layout.columns_are_open = map.columns.empty() && map.bench.empty();
  for (const std::string& file : files) {
    recordings.push_back(ReadRecording(file, layout, map.clock));
    if (!by.empty()) recordings.back().remarks.push_back(fmt::format("by its {} a {}: taken as --map {}", by, map.title, map.name));
    if (layout.columns_are_open) RefuseRowsOfChannels(recordings.back());
    const std::string others = layout.columns_are_open && map.name.empty() ? ReadyMapsByNames(recordings.back()) : "";
    if (!others.empty()) recordings.back().remarks.push_back("by its names it may be of another kind" + others);
    TakeSought(map, recordings.back());
  }
  TakeUnnamedClock(map, recordings);
  if (!TakeSideBySide(map, recordings)) TakeAxis(map, recordings);
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
MostReadings MostOf(const BenchFormat& bench, const Map& map, std::size_t sessions) {
  constexpr std::size_t kCompared = 20000;
  const bool is_stated = map.average.most_readings > 0;
  const std::size_t all = is_stated        ? static_cast<std::size_t>(map.average.most_readings)
                          : bench.compared ? kCompared
                                           : std::numeric_limits<std::size_t>::max();
  return {std::max<std::size_t>(all / sessions, kFewestReadings), is_stated};
}

/// Lengths start again nowhere, unless the map says where.
Session WithoutGaps(const Session& session, const BenchFormat& bench, const Map& map, const Joined& joined, std::vector<LeftOut>& left_out) {
  const bool wraps = bench.compared && (!joined.linear || map.course.wrap_rad > 0.0);
  if (!wraps || session.Rows() < 2) return session;
  return WithoutWrapGaps(session, ComparedColumns(bench), map.course.wrap_rad > 0.0 ? map.course.wrap_rad : units::turn, left_out);
}

Imported MakeReadings(const std::vector<Recording>& recordings, Map map) {
  std::vector<std::string> guessed;
  TakeReadyMapOfList(recordings, map, guessed);
  const BenchFormat& bench = BenchFor(recordings, map);
  FillIn(recordings, bench, ComparedColumns(bench), map, guessed);
  RequireAxisWasThere(map);
  RequireColumns(bench, map, recordings);
  const Joined joined = Join(recordings, map, bench.compared ? bench.compared->shown : map.columns.at(0).column);
  Imported imported;
  imported.bench = bench.name;
  Maker maker(bench, map, joined.linear);
  const MostReadings most = MostOf(bench, map, joined.sessions.size());
  for (const Session& session : joined.sessions) {
    const Session whole = WithoutGaps(WholeRows(session, bench, map, maker.tally.left_out), bench, map, joined, maker.tally.left_out);
    maker.Take(whole, most, imported);
  }
  const std::size_t fewest = bench.compared ? kFewestCompared : kFewestReadings;
  if (imported.readings.size() < fewest)
    throw InputError(recordings[0].file, fmt::format("{} readings are left{}", imported.readings.size(), CostOf(maker.tally.left_out)),
                     fmt::format("{} at least", fewest));
  if (bench.compared && imported.readings.size() < kFewestToDiagnose)
    maker.tally.remarks.push_back(fmt::format("{} readings are too few to name a cause: diagnose takes {} at least", imported.readings.size(), kFewestToDiagnose));
  if (bench.compared && maker.tally.stops && !Gives(map, "position"))
    NumberPositions(imported.readings, *ColumnOf(bench, bench.compared->reference));
  if (bench.compared)
    imported.set =
        bench.compared->scenario_of({maker.tally.stops, (maker.tally.high - maker.tally.low) / units::turn,
                                     joined.linear ? joined.turn_m : 0.0});
  for (const std::string& key : map.set) imported.set.push_back(key);
  imported.assumed = maker.tally.assumed;
  imported.story = StoryOf(recordings, joined, maker.tally, guessed, map, imported);
  return imported;
}

}  // namespace

Imported Import(const std::vector<std::string>& files, const Map& map) {
  Map taken = map;
  const std::vector<Recording> recordings = ReadAll(files, taken);
  return MakeReadings(recordings, taken);
}

Seen Look(const std::vector<std::string>& files, const Map& map) {
  Map taken = map;
  const std::vector<Recording> recordings = ReadAll(files, taken);
  Seen seen;
  for (const Recording& recording : recordings) seen.text += Describe(recording);
  try {
    seen.imported = MakeReadings(recordings, taken);
    seen.text += "\nIt would be imported like this:\n" + seen.imported->story;
  } catch (const InputError& needs) {
    for (const Recording& recording : recordings) seen.text += RemarksOn(recording);
    seen.needs = needs;
  }
  return seen;
}

}  // namespace twinbench::imports
