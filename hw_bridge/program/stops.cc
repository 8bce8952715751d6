#include "hw_bridge/program/stops.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/reading_column.h"
#include "twin/core/whole_file.h"

namespace twinbench::hw {
namespace {

constexpr const char* kReading = "reading";
const Quantity kStamp{"stamp_s"};  // of a line that passed

/// The plan comes from a twin: what that measured of the circumstances is none of a real bench.
std::vector<Reading> WithoutMeasured(std::vector<Reading> planned) {
  for (Reading& reading : planned) {
    reading.temperature_degC = kNaN;
    reading.extra.clear();  // encoders of axes at rest
    if (std::isfinite(kStamp(std::as_const(reading)))) kStamp(reading) = kNaN;
  }
  return planned;
}

CsvTable TableOf(const std::vector<Reading>& readings, const std::string& bench) {
  std::stringstream text;
  WriteReadingsCsv(WithoutMeasured(readings), bench, text);
  return ParseCsv(text, "the planned readings");
}

std::set<std::string> ShownColumns(const std::string& bench) {
  std::set<std::string> shown;
  for (const ReadingColumn& column : FormatOf(bench).columns) {
    if (column.IsShown()) shown.insert(column.name);
  }
  return shown;
}

/// What a program may add of axes at rest.
std::set<std::string> EncoderColumns(const std::vector<Reading>& planned) {
  std::set<std::string> names;
  for (const Reading& reading : planned) {
    for (const auto& [name, text] : reading.extra) names.insert(name);
  }
  return names;
}

void PrintLine(std::ostream& out, const std::vector<std::string>& fields) {
  for (std::size_t k = 0; k < fields.size(); ++k) out << (k == 0 ? "" : ",") << QuoteCsv(fields[k]);
  out << '\n';
}

void RequireKnown(const CsvTable& table, const std::vector<std::string>& known) {
  for (const std::string& column : table.columns) {
    if (std::ranges::find(known, column) == known.end())
      throw InputError(table.WhereHeader(), "there is no column " + column,
                       "columns of readings.csv; the nearest is " + Nearest(column, known));
  }
  if (!table.Column(kReading))
    throw InputError(table.WhereHeader(), "there is no column reading", "the number of the measuring position, as in stops.csv");
}

/// The program's rows by the number of their stop, the first of each.
std::map<std::string, const CsvTable::Row*> RowsByStop(const CsvTable& table) {
  std::map<std::string, const CsvTable::Row*> rows;
  const std::size_t at = *table.Column(kReading);
  for (const CsvTable::Row& row : table.rows) rows.emplace(row.fields[at], &row);
  return rows;
}

/// A stop's field as the program has it, or as planned if the bench does not show it.
std::string FieldOf(const CsvTable& table, const CsvTable::Row& row, const std::string& column, bool is_shown,
                    const std::string& planned) {
  const auto at = table.Column(column);
  if (at && !row.fields[*at].empty()) return row.fields[*at];
  return is_shown ? "" : planned;
}

}  // namespace

void WriteStops(const std::vector<Reading>& planned, const std::string& bench, const std::string& path) {
  const CsvTable table = TableOf(planned, bench);
  const std::set<std::string> shown = ShownColumns(bench);
  std::ostringstream out;
  const auto print = [&](const std::vector<std::string>& all) {
    std::vector<std::string> fields;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (!shown.contains(table.columns[k])) fields.push_back(all[k]);
    }
    PrintLine(out, fields);
  };
  print(table.columns);
  for (const CsvTable::Row& row : table.rows) print(row.fields);
  WriteFileAtOnce(path, out.str());
}

ReadStops ReadStopsBack(const std::string& path, const std::vector<Reading>& planned, const std::string& bench) {
  if (!std::filesystem::exists(path)) throw BenchError("the program wrote no " + path);
  const CsvTable written = ReadCsv(path), stops = TableOf(planned, bench);
  std::vector<std::string> columns = stops.columns;
  if (!stops.Column(kStatusColumn)) columns.push_back(kStatusColumn);
  for (const std::string& encoder : EncoderColumns(planned)) {
    if (written.Column(encoder)) columns.push_back(encoder);
  }
  RequireKnown(written, columns);
  const std::set<std::string> shown = ShownColumns(bench);
  const std::map<std::string, const CsvTable::Row*> rows = RowsByStop(written);
  std::stringstream merged;
  PrintLine(merged, columns);
  ReadStops back;
  for (const CsvTable::Row& stop : stops.rows) {
    const auto row = rows.find(stop.fields[*stops.Column(kReading)]);
    if (row == rows.end()) {
      ++back.missing;
      continue;
    }
    std::vector<std::string> fields;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::string as_planned = k < stop.fields.size() && columns[k] != kStatusColumn ? stop.fields[k] : "";
      fields.push_back(FieldOf(written, *row->second, columns[k], shown.contains(columns[k]), as_planned));
    }
    PrintLine(merged, fields);
  }
  const std::size_t used = stops.rows.size() - static_cast<std::size_t>(back.missing);
  if (used == 0) throw BenchError(path + ": no row is of a measuring position that was asked for");
  back.extra = static_cast<int>(written.rows.size() - used);
  back.readings = ParseReadingsCsv(merged, path, bench);
  return back;
}

}  // namespace twinbench::hw
