#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "twin/core/errors.h"
#include "twin/import/clock.h"
#include "twin/import/common.h"
#include "twin/import/statements.h"
#include "twin/import/table.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

bool HasPart(const std::string& name, const std::vector<const char*>& parts) {
  return std::ranges::any_of(parts, [&name](const char* part) { return name.find(part) != std::string::npos; });
}

bool IsCalledTime(const Column& column) {
  const std::string name = SmallLetters(column.name);
  if (column.unit == "instant" || column.unit == "time of day") return true;
  for (const char* word : {"time", "timestamp", "t", "zeit", "zeitstempel", "date", "datetime", "utc", "uhrzeit", "datum", "temps",
                           "tiempo", "tempo", "время", "时间", "ts", "stamp", "elapsed", "millis", "micros", "jd", "mjd", "bjd", "hjd", "ms_today"}) {
    if (name == word || name.starts_with(std::string(word) + "_") || name.starts_with(std::string(word) + " ") ||
        name.ends_with(std::string("_") + word))
      return column.IsNumber();
  }
  const auto unit = UnitNamed(column.unit.empty() && name != "min" ? name : column.unit);  // "ms"; "min" is the least
  return column.IsNumber() && unit && unit->dimension == Dimension::kTime && !HasPart(name, {"dwell", "pwm", "pulse", "width", "period", "duration", "delay"});
}

/// A time that each row has of its own, as a dwell, does not go on from row to row.
bool GoesOn(const Column& column) {
  const std::vector<double> steps = StepsOf(column.value);
  const auto back = std::ranges::count_if(steps, [](double step) { return step < 0.0; });
  const bool moves = std::ranges::any_of(steps, [](double step) { return step > 0.0; });
  return moves && 10 * back <= std::ssize(steps);
}

/// Named as the file's head has it, with its unit or without.
auto ColumnCalled(const std::string& name, std::vector<Column>& columns) {
  const auto found = std::ranges::find(columns, name, &Column::name);
  if (found != columns.end()) return found;
  const NameAndUnit split = SplitHeader(name);
  return std::ranges::find_if(columns, [&split](const Column& c) { return c.name == split.name && c.unit == split.unit; });
}

/// "time [ms]" has its unit; "millis" is one.
std::string UnitOfClock(const ClockSettings& settings, const Column& column) {
  if (!settings.unit.empty()) return settings.unit;
  if (column.unit.empty() && SmallLetters(column.name).ends_with("jd")) return "day";  // a Julian date
  if (column.unit.empty() && SmallLetters(column.name).starts_with("ms_")) return "ms";
  const auto name = UnitNamed(column.name);
  return column.unit.empty() && name && name->dimension == Dimension::kTime ? std::string(name->name) : column.unit;
}

/// Rows in order, counted, or by a rate.
void CountRows(double rate_Hz, Track& track) {
  track.time_s.resize(track.Rows());
  for (std::size_t i = 0; i < track.time_s.size(); ++i)
    track.time_s[i] = static_cast<double>(i) / (rate_Hz > 0.0 ? rate_Hz : 1.0);
  if (rate_Hz > 0.0) track.clock = fmt::format("rows at {:g} Hz, as the map says", rate_Hz);
}

/// Where a clock begins anew, as one of each part of a file does; none where it goes back in another way.
std::vector<std::size_t> BeginsAnew(const std::vector<double>& time_s) {
  constexpr std::size_t kFewestRows = 12;  // of a part
  constexpr double kAtBegin = 0.1;         // of the part before
  std::vector<std::size_t> begins;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] < time_s[i - 1])) continue;
    const bool is_begin = time_s[i] - time_s[begin] < kAtBegin * (time_s[i - 1] - time_s[begin]);
    if (!is_begin || i - begin < kFewestRows) return {};
    begins.push_back(begin = i);
  }
  return time_s.size() - begin < kFewestRows ? std::vector<std::size_t>() : begins;
}

/// Parts with a clock each follow one another. @return how many there are.
std::size_t PutOneBehindTheOther(std::vector<double>& time_s) {
  constexpr double kPause_s = 1.0;
  const std::vector<std::size_t> begins = BeginsAnew(time_s);
  for (const std::size_t begin : begins) {
    const double later_s = time_s[begin - 1] + kPause_s - time_s[begin];
    for (std::size_t i = begin; i < time_s.size(); ++i) time_s[i] += later_s;
  }
  return begins.size() + 1;
}

}  // namespace

void TakeStatedRate(Track& track) {
  const std::vector<double> period_s = StatedValues(track, {"sampling period", "sample period", "sampling time", "sample time", "sampling interval", "sample interval",
                                                            "abtasttakt", "abtastzeit", "abtastperiode"}, *UnitNamed("s"));
  if (!period_s.empty() && period_s.front() > 0.0) {
    CountRows(1.0 / period_s.front(), track);
    track.clock = fmt::format("rows every {:g} s, as the file says", period_s.front());
    return;
  }
  for (const auto& [name, number] : track.numbers) {
    const std::string small = SmallLetters(name);
    const bool is_rate = HasPart(small, {"sampl", "action", "control", "acquisition", "log"}) && HasPart(small, {"rate", "hz", "freq"});
    if (!is_rate || !(number > 0.0)) continue;
    CountRows(number, track);
    track.clock = fmt::format("rows at {:g} Hz, as \"{}\" says", number, name);
    return;
  }
}

void FindClock(const ClockSettings& settings, const std::string& where, Track& track) {
  const auto is_clock = [](const Column& column) { return IsCalledTime(column) && GoesOn(column); };
  auto found = settings.column.empty() ? std::ranges::find_if(track.columns, is_clock) : ColumnCalled(settings.column, track.columns);
  if (!settings.column.empty() && found == track.columns.end())
    throw InputError(where, fmt::format("there is no column \"{}\" to take the time from", settings.column),
                     "[time] column = one of the file's columns");
  if (found == track.columns.end() || (settings.column.empty() && settings.rate_Hz > 0.0)) {
    CountRows(settings.rate_Hz, track);
    if (!track.HasClock()) TakeStatedRate(track);
    return;
  }
  if (!found->IsNumber())
    throw InputError(where, fmt::format("\"{}\" holds words and no time", found->name), "times");
  Column column = std::move(*found);
  track.columns.erase(found);
  track.time_s = std::move(column.value);
  if (column.unit == "instant" || column.unit == "time of day") {
    track.absolute = column.unit == "instant";
    track.clock = fmt::format("{} ({})", column.name, column.unit);
    return;
  }
  if (settings.rate_Hz > 0.0) {  // the column counts samples
    for (double& t : track.time_s) t /= settings.rate_Hz;
    track.clock = fmt::format("{}, samples at {:g} Hz", column.name, settings.rate_Hz);
    return;
  }
  const std::string unit = UnitOfClock(settings, column);
  const auto clock = ClockOf(track.time_s, unit);
  if (!clock)
    throw InputError(where,
                     fmt::format("{} is given in \"{}\", which is no unit of time", column.name, unit),
                     "[time] unit = s, ms, us, ns, min, h, day, epoch or filetime" + NearestUnit(unit, {Dimension::kTime}));
  for (double& t : track.time_s) t = (t - clock->origin) * clock->to_s;
  track.absolute = clock->absolute;
  const bool is_said = !unit.empty() || clock->absolute;
  track.clock = fmt::format("{} [{}{}]", column.name, clock->words, is_said ? "" : ", which is not said");
  if (const std::size_t parts = clock->absolute ? 1 : PutOneBehindTheOther(track.time_s); parts > 1)
    track.clock += fmt::format(", which begins anew: {} parts are put one behind the other", parts);
}

}  // namespace twinbench::imports
