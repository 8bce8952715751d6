#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "twin/core/bench_format.h"
#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/reading.h"
#include "twin/core/reading_clock.h"
#include "twin/core/reading_column.h"
#include "twin/core/whole_file.h"

namespace twinbench {
namespace {

void RequireColumns(const CsvTable& table, const BenchFormat& bench) {
  std::vector<std::string> missing, others = table.columns;
  for (const ReadingColumn& column : bench.columns) {
    if (std::erase(others, column.name) == 0 && column.MustBeThere()) missing.push_back(column.name);
  }
  if (!missing.empty())
    throw InputError(table.WhereHeader(), fmt::format("required columns are missing: {}", fmt::join(missing, ", ")),
                     "readings of the bench " + bench.name + NearestColumn(missing.front(), others));
}

/// Nobody measured the time of a reading without a clock: the file has none, and in memory its rows are counted.
bool IsTimeWithoutClock(const ReadingColumn& column, const Reading& reading) {
  return column.name == "time_s" && !HasClock({&reading, 1});
}

void ParseField(const CsvTable& table, const CsvTable::Row& row, const ReadingColumn& column, Reading& reading) {
  const std::string& field = row.fields[*table.Column(column.name)];
  if (field.empty() && column.MayBeEmpty()) return;
  if (field.empty() && IsTimeWithoutClock(column, reading)) {
    reading.time = Time(std::chrono::seconds(reading.reading));
    return;
  }
  if (column.parse(reading, field)) return;
  throw InputError(table.Where(row), fmt::format("{} is \"{}\"", column.name, field), column.expected);
}

bool IsComplete(Reading& reading, const std::vector<ReadingColumn>& columns) {
  return std::ranges::all_of(columns, [&](const ReadingColumn& column) {
    return column.role != ColumnRole::kShown || std::isfinite(column.number(reading));
  });
}

/// A reading either is kOk with all its values or has none.
void Harmonise(Reading& reading, const std::vector<ReadingColumn>& columns) {
  if (reading.status == ReadingStatus::kOk && !IsComplete(reading, columns))
    reading.status = ReadingStatus::kMissing;
  if (reading.status == ReadingStatus::kOk) return;
  for (const ReadingColumn& column : columns) {
    if (column.IsShown()) column.number(reading) = kNaN;
  }
}

/// Those without which a reading of this file is missing. What the bench shows otherwise is not missed where
/// another instrument was read alone.
std::vector<ReadingColumn> NeededIn(const CsvTable& table, std::vector<ReadingColumn> columns) {
  const auto has_none = [&table](const ReadingColumn& column) {
    const auto at = table.Column(column.name);
    const auto is_empty = [&at](const CsvTable::Row& row) { return row.fields[*at].empty(); };
    return !at || std::ranges::all_of(table.rows, is_empty);
  };
  const bool is_of_another =
      std::ranges::any_of(columns,
                          [&](const ReadingColumn& c) { return c.IsOfAnotherInstrument() && !has_none(c); }) &&
      std::ranges::all_of(columns,
                          [&](const ReadingColumn& c) { return c.role != ColumnRole::kShown || has_none(c); });
  std::erase_if(columns, [&](const ReadingColumn& column) {
    return (column.may_be_absent || (is_of_another && column.role == ColumnRole::kShown)) && has_none(column);
  });
  return columns;
}

Reading ParseRow(const CsvTable& table, const CsvTable::Row& row, const std::vector<ReadingColumn>& columns,
                 const std::vector<ReadingColumn>& needed) {
  Reading reading;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const bool is_known = std::ranges::find(columns, table.columns[i], &ReadingColumn::name) != columns.end();
    if (!is_known) reading.extra[table.columns[i]] = row.fields[i];
  }
  for (const ReadingColumn& column : columns)
    if (table.Column(column.name)) ParseField(table, row, column, reading);
  Harmonise(reading, needed);
  return reading;
}

/// Checks what only shows against the readings before.
void CheckOrder(const CsvTable& table, const CsvTable::Row& row, const Reading& reading, Time last,
                std::set<int>& numbers) {
  if (!numbers.insert(reading.reading).second)
    throw InputError(table.Where(row), fmt::format("reading {} comes twice", reading.reading), "every number once");
  if (reading.time < last)
    throw InputError(table.Where(row), fmt::format("time_s goes back to {}", PrintTime(reading.time)),
                     "time order");
}

/// The columns to write: the status only if it says something, those of another instrument only if it was read.
std::vector<ReadingColumn> ColumnsFor(const std::vector<Reading>& readings, const BenchFormat& bench) {
  const bool all_ok =
      std::ranges::all_of(readings, [](const Reading& r) { return r.status == ReadingStatus::kOk; });
  std::vector<ReadingColumn> columns = bench.columns;
  if (all_ok) std::erase_if(columns, [](const ReadingColumn& column) { return column.name == kStatusColumn; });
  std::erase_if(columns, [&readings](const ReadingColumn& column) {
    return column.IsOfAnotherInstrument() &&
           std::ranges::all_of(readings, [&column](const Reading& r) { return column.print(r).empty(); });
  });
  return columns;
}

/// The bench that is stated, or else the one that the columns speak of.
const BenchFormat& FormatOfFile(const CsvTable& table, const std::string& stated_bench) {
  if (!stated_bench.empty()) return FormatOf(stated_bench, table.name);
  const BenchFormat* format =
      FormatByColumns([&](const ReadingColumn& column) { return table.Column(column.name).has_value(); });
  if (format) return *format;
  throw InputError(table.WhereHeader(), "the columns are those of no known bench",
                   "readings of " + fmt::format("{}", fmt::join(BenchNames(), ", ")));
}

std::set<std::string> ExtraColumns(const std::vector<Reading>& readings) {
  std::set<std::string> names;
  for (const Reading& reading : readings) {
    for (const auto& [name, text] : reading.extra) names.insert(name);
  }
  return names;
}

std::string PrintRow(const Reading& reading, const std::vector<ReadingColumn>& columns,
                     const std::set<std::string>& extra) {
  std::string line;
  for (const ReadingColumn& column : columns)
    line += (IsTimeWithoutClock(column, reading) ? "" : column.print(reading)) + ',';
  for (const std::string& name : extra) {
    const auto found = reading.extra.find(name);
    line += (found == reading.extra.end() ? "" : QuoteCsv(found->second)) + ',';
  }
  line.back() = '\n';
  return line;
}

/// A clock that counts from 1970 counts from the first reading: drifts begin there, and not half a century before.
void CountFromFirst(std::vector<Reading>& readings) {
  constexpr double kThreeYears_s = 1e8;  // no run takes so long
  if (readings.empty() || ToSeconds(readings.front().time) < kThreeYears_s) return;
  const Duration before = readings.front().time.time_since_epoch();
  for (Reading& reading : readings) reading.time -= before;
}

}  // namespace

void WriteReadingsCsv(const std::vector<Reading>& readings, const std::string& bench, std::ostream& out) {
  const std::vector<ReadingColumn> columns = ColumnsFor(readings, FormatOf(bench));
  const std::set<std::string> extra = ExtraColumns(readings);
  std::string header;
  for (const ReadingColumn& column : columns) header += column.name + ',';
  for (const std::string& name : extra) header += QuoteCsv(name) + ',';
  header.back() = '\n';
  out << header;
  for (const Reading& reading : readings) out << PrintRow(reading, columns, extra);
}

void WriteReadingsCsv(const std::vector<Reading>& readings, const std::string& bench, const std::string& path) {
  std::ostringstream out;
  WriteReadingsCsv(readings, bench, out);
  WriteFileAtOnce(path, out.str());
}

std::vector<Reading> ParseReadingsCsv(std::istream& in, const std::string& name, const std::string& bench) {
  const CsvTable table = ParseCsv(in, name);
  const BenchFormat& format = FormatOfFile(table, bench);
  RequireColumns(table, format);
  std::vector<Reading> readings;
  std::set<int> numbers;
  const std::vector<ReadingColumn> needed = NeededIn(table, format.columns);
  for (const CsvTable::Row& row : table.rows) {
    const Reading reading = ParseRow(table, row, format.columns, needed);
    CheckOrder(table, row, reading, readings.empty() ? Time::min() : readings.back().time, numbers);
    readings.push_back(reading);
  }
  if (format.into_frame) format.into_frame(readings);
  return readings;
}

std::vector<Reading> ReadReadingsCsv(const std::string& path, const std::string& bench) {
  std::istringstream in(InputText(path, "a readings.csv"));
  std::vector<Reading> readings = ParseReadingsCsv(in, path, bench);
  CountFromFirst(readings);
  return readings;
}

}  // namespace twinbench
