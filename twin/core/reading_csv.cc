#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

constexpr const char* kStatusColumn = "status";
constexpr const char* kMeasuredColumn = "measured_deg";
constexpr const char* kMultitoothColumn = "multitooth_deg";
constexpr const char* kHeadColumn = "head_deg";

/// One column of readings.csv, for both ways.
struct ReadingColumn {
  std::string name;
  bool required = false;                                         // the column must be there ...
  std::function<std::string(const Reading&)> print;              // empty: not available
  std::function<bool(Reading&, const std::string&)> parse = {};  // false: not what is expected
  std::string expected;
  bool may_be_empty = false;  // ... but a reading's status may say why it has no value
};

/// @param field  Gives the number's place in a reading, as in `[](auto& r) -> auto& { return r.dwell_s; }`.
template <class Field>
ReadingColumn Number(const std::string& name, double to_SI, bool required, Field field) {
  return {name, required,
          [=](const Reading& r) { return std::isfinite(field(r)) ? PrintInUnit(field(r), to_SI) : ""; },
          [=](Reading& r, const std::string& text) {
            if (const auto number = ParseInUnit(text, to_SI)) field(r) = *number;
            return std::isfinite(field(r));
          },
          "a finite number"};
}

template <class Field>
ReadingColumn WholeNumber(const std::string& name, bool required, long long lowest, Field field) {
  return {name, required, [=](const Reading& r) { return fmt::format("{}", field(r)); },
          [=](Reading& r, const std::string& text) {
            const auto number = ParseWholeNumber(text);
            if (!number || *number < lowest || *number > std::numeric_limits<int>::max()) return false;
            field(r) = static_cast<int>(*number);
            return true;
          },
          fmt::format("a whole number, {} or more", lowest)};
}

/// Seconds with all nine decimals that are not zero, so that every nanosecond survives.
std::string PrintTime(Time time) {
  const std::int64_t count_ns = time.time_since_epoch().count();
  const std::uint64_t size_ns = count_ns < 0 ? ~static_cast<std::uint64_t>(count_ns) + 1 : count_ns;
  std::string text = fmt::format("{}{}.{:09}", count_ns < 0 ? "-" : "", size_ns / 1000000000, size_ns % 1000000000);
  text.erase(text.find_last_not_of('0') + 1);
  return text.back() == '.' ? text + '0' : text;
}

/// In extended precision: a double loses nanoseconds after 104 days.
bool ParseTime(Time& time, const std::string& text) {
  long double time_s = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time_s);
  if (error != std::errc() || end != text.data() + text.size()) return false;
  if (!(std::abs(time_s) < 9.2e9L)) return false;  // 2^63 ns
  time = Time(Duration(std::llround(time_s * 1e9L)));
  return true;
}

/// @param rest  0, at rest, is a direction too.
ReadingColumn Direction(bool rest) {
  const auto parse = [rest](Reading& reading, const std::string& text) {
    const auto direction = ParseWholeNumber(text);
    if (!direction || *direction < -1 || *direction > 1 || (*direction == 0 && !rest)) return false;
    reading.direction = static_cast<int>(*direction);
    return true;
  };
  return {"direction", true, [](const Reading& r) { return fmt::format("{}", r.direction); }, parse,
          rest ? "1, -1 or 0 (at rest)" : "1 or -1"};
}

/// Takes over the value of a name that has been looked up; false if there was none.
template <class Value>
bool Assign(Value& field, const std::optional<Value>& found) {
  if (found) field = *found;
  return found.has_value();
}

void AddCommonColumns(std::vector<ReadingColumn>& columns, bool rest) {
  columns.push_back(WholeNumber(
      "reading", true, 0, [](auto& r) -> auto& { return r.reading; }));
  columns.push_back({"time_s", true, [](const Reading& r) { return PrintTime(r.time); },
                     [](Reading& r, const std::string& text) { return ParseTime(r.time, text); },
                     "seconds since the start of the run"});
  columns.push_back(WholeNumber(
      "setup", true, 0, [](auto& r) -> auto& { return r.setup; }));
  columns.push_back(WholeNumber(
      "pass", true, 0, [](auto& r) -> auto& { return r.pass; }));
  columns.push_back(Direction(rest));
  columns.push_back(WholeNumber(
      "position", true, 0, [](auto& r) -> auto& { return r.position; }));
  columns.push_back({"phase", true, [](const Reading& r) { return std::string(PhaseName(r.phase)); },
                     [](Reading& r, const std::string& text) { return Assign(r.phase, PhaseOf(text)); },
                     "calibration, full_circle, stability or verification"});
  columns.push_back({kStatusColumn, false,
                     [](const Reading& r) { return std::string(ReadingStatusName(r.status)); },
                     [](Reading& r, const std::string& text) { return Assign(r.status, ReadingStatusOf(text)); },
                     "ok, saturated, no_light, clipped_spot, overrun or missing"});
}

/// A voltage may be empty in a required column: the reading's status says why.
ReadingColumn Voltage(const std::string& channel, std::size_t i) {
  ReadingColumn column = Number(
      channel + "_V", 1.0, true, [i](auto& r) -> auto& { return r.mean_V[i]; });
  column.expected = "a finite number of V, or nothing";
  column.may_be_empty = true;
  return column;
}

void AddRotaryColumns(std::vector<ReadingColumn>& columns) {
  columns.push_back(Number(
      "target_deg", units::deg, true, [](auto& r) -> auto& { return r.target_rad; }));
  columns.push_back(Number(
      "reference_deg", units::deg, true, [](auto& r) -> auto& { return r.reference_rad; }));
  for (std::size_t i = 0; i < kChannels; ++i) columns.push_back(Voltage(kChannelNames[i], i));
  for (std::size_t i = 0; i < kChannels; ++i) {
    const std::string name = std::string(kChannelNames[i]) + "_std_V";
    columns.push_back(Number(
        name, 1.0, false, [i](auto& r) -> auto& { return r.std_V[i]; }));
  }
}

/// A number that a required column may lack: the reading's status says why.
template <class Field>
ReadingColumn Shown(const std::string& name, double to_SI, const std::string& unit, Field field) {
  ReadingColumn column = Number(name, to_SI, true, field);
  column.may_be_empty = true;
  column.expected = "a finite number of " + unit + ", or nothing";
  return column;
}

void AddEncoderColumns(std::vector<ReadingColumn>& columns) {
  columns.push_back(Number(
      "reference_deg", units::deg, true, [](auto& r) -> auto& { return r.reference_rad; }));
  columns.push_back(Shown(
      kMeasuredColumn, units::deg, "deg", [](auto& r) -> auto& { return r.measured_rad; }));
  columns.push_back(Number(
      "velocity_deg_s", units::deg, false, [](auto& r) -> auto& { return r.velocity_rad_s; }));
}

void AddTurntableColumns(std::vector<ReadingColumn>& columns) {
  columns.push_back(Number(
      "turntable_deg", units::deg, true, [](auto& r) -> auto& { return r.target_rad; }));
  columns.push_back(Number(
      kMultitoothColumn, units::deg, true, [](auto& r) -> auto& { return r.reference_rad; }));
  columns.push_back(Shown(
      "autocollimator_x_arcsec", units::arcsec, "arcsec",
      [](auto& r) -> auto& { return r.autocollimator_yaw_rad; }));
  columns.push_back(Shown(
      "autocollimator_y_arcsec", units::arcsec, "arcsec",
      [](auto& r) -> auto& { return r.autocollimator_tilt_rad; }));
}

void AddHobColumns(std::vector<ReadingColumn>& columns) {
  columns.push_back(Shown(
      "table_encoder_deg", units::deg, "deg", [](auto& r) -> auto& { return r.measured_rad; }));
  columns.push_back(Shown(
      "hob_encoder_deg", units::deg, "deg", [](auto& r) -> auto& { return r.reference_rad; }));
  columns.push_back(Number(
      kHeadColumn, units::deg, true, [](auto& r) -> auto& { return r.head_rad; }));
  columns.push_back(Number(
      "interferometer_arcsec", units::arcsec, false, [](auto& r) -> auto& { return r.interferometer_rad; }));
  columns.push_back(Number(
      "velocity_deg_s", units::deg, false, [](auto& r) -> auto& { return r.velocity_rad_s; }));
}

void AddConditionColumns(std::vector<ReadingColumn>& columns) {
  ReadingColumn samples = WholeNumber(
      "n_samples", false, 0, [](auto& r) -> auto& { return r.n_samples; });
  samples.print = [](const Reading& r) { return r.n_samples > 0 ? fmt::format("{}", r.n_samples) : ""; };
  columns.push_back(samples);
  columns.push_back(Number(
      "dwell_s", 1.0, false, [](auto& r) -> auto& { return r.dwell_s; }));
  columns.push_back(Number(
      "temperature_degC", 1.0, false, [](auto& r) -> auto& { return r.temperature_degC; }));
}

void AddAutocollimatorColumns(std::vector<ReadingColumn>& columns) {
  columns.push_back(Number(
      "autocollimator_yaw_arcsec", units::arcsec, false,
      [](auto& r) -> auto& { return r.autocollimator_yaw_rad; }));
  columns.push_back(Number(
      "autocollimator_tilt_arcsec", units::arcsec, false,
      [](auto& r) -> auto& { return r.autocollimator_tilt_rad; }));
}

std::vector<ReadingColumn> Columns(const std::string& bench) {
  std::vector<ReadingColumn> columns;
  AddCommonColumns(columns, bench == kEncoderBench || bench == kHobBench);
  if (bench == kEncoderBench) AddEncoderColumns(columns);
  if (bench == kTurntableBench) AddTurntableColumns(columns);
  if (bench == kHobBench) AddHobColumns(columns);
  if (bench == kRotaryBench) AddRotaryColumns(columns);
  AddConditionColumns(columns);
  if (bench == kRotaryBench) AddAutocollimatorColumns(columns);
  return columns;
}

std::string BenchOfColumns(const CsvTable& table) {
  if (table.Column(kMultitoothColumn)) return kTurntableBench;
  if (table.Column(kHeadColumn)) return kHobBench;
  return table.Column(kMeasuredColumn) && !table.Column("target_deg") ? kEncoderBench : kRotaryBench;
}

void RequireColumns(const CsvTable& table, const std::vector<ReadingColumn>& columns, const std::string& bench) {
  std::string missing;
  for (const ReadingColumn& column : columns) {
    if (column.required && !table.Column(column.name)) missing += (missing.empty() ? "" : ", ") + column.name;
  }
  if (!missing.empty())
    throw InputError(table.WhereHeader(), "required columns are missing: " + missing,
                     "readings of the bench " + bench);
}

void ParseField(const CsvTable& table, const CsvTable::Row& row, const ReadingColumn& column, Reading& reading) {
  const std::string& field = row.fields[*table.Column(column.name)];
  if (field.empty() && (!column.required || column.may_be_empty)) return;
  if (column.parse(reading, field)) return;
  throw InputError(table.Where(row), fmt::format("{} is \"{}\"", column.name, field), column.expected);
}

bool HasAllVoltages(const Reading& reading) {
  for (const double mean_V : reading.mean_V) {
    if (std::isnan(mean_V)) return false;
  }
  return true;
}

bool IsComplete(const Reading& r, const std::string& bench) {
  if (bench == kEncoderBench) return std::isfinite(r.measured_rad);
  if (bench == kTurntableBench) return std::isfinite(r.autocollimator_yaw_rad + r.autocollimator_tilt_rad);
  if (bench == kHobBench) return std::isfinite(r.measured_rad + r.reference_rad);
  return HasAllVoltages(r);
}

/// A reading either is kOk with all its values or has none.
void Harmonise(Reading& reading, const std::string& bench) {
  const bool complete = IsComplete(reading, bench);
  if (reading.status == ReadingStatus::kOk && !complete) reading.status = ReadingStatus::kMissing;
  if (reading.status == ReadingStatus::kOk) return;
  reading.measured_rad = kNaN;
  reading.mean_V.fill(kNaN);
  reading.std_V.fill(kNaN);
  if (bench == kHobBench) reading.reference_rad = reading.interferometer_rad = kNaN;
  if (bench == kTurntableBench) reading.autocollimator_yaw_rad = reading.autocollimator_tilt_rad = kNaN;
}

Reading ParseRow(const CsvTable& table, const CsvTable::Row& row, const std::vector<ReadingColumn>& columns,
                 const std::string& bench) {
  Reading reading;
  std::set<std::string> known;
  for (const ReadingColumn& column : columns) {
    known.insert(column.name);
    if (table.Column(column.name)) ParseField(table, row, column, reading);
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (!known.contains(table.columns[i])) reading.extra[table.columns[i]] = row.fields[i];
  }
  Harmonise(reading, bench);
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

/// How far `target + sense x reference` wanders within the set-ups, whole turns apart [rad].
double Wander_rad(const std::vector<Reading>& readings, double sense) {
  std::map<int, double> first_rad;
  double widest_rad = 0.0;
  for (const Reading& r : readings) {
    if (r.phase == Phase::kCalibration) continue;  // the turntable moves alone
    const double sum_rad = r.target_rad + sense * r.reference_rad;
    const double start_rad = first_rad.try_emplace(r.setup, sum_rad).first->second;
    widest_rad = std::max(widest_rad, std::abs(std::remainder(sum_rad - start_rad, 2.0 * units::kPi)));
  }
  return widest_rad;
}

/// Some count the multi-tooth table's way back as positive. Here both tables count counter-clockwise, so that their
/// sum stays.
void CountBothTheSameWay(std::vector<Reading>& readings) {
  constexpr double kNothing_rad = 1e-6;
  if (Wander_rad(readings, 1.0) <= kNothing_rad || Wander_rad(readings, -1.0) > kNothing_rad) return;
  for (Reading& r : readings) r.reference_rad = -r.reference_rad;
}

/// The columns to write: the status only if it says something.
std::vector<ReadingColumn> ColumnsFor(const std::vector<Reading>& readings) {
  bool all_ok = true;
  for (const Reading& reading : readings) all_ok = all_ok && reading.status == ReadingStatus::kOk;
  std::vector<ReadingColumn> columns = Columns(BenchOf(readings));
  if (all_ok) std::erase_if(columns, [](const ReadingColumn& column) { return column.name == kStatusColumn; });
  return columns;
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
  for (const ReadingColumn& column : columns) line += column.print(reading) + ',';
  for (const std::string& name : extra) {
    const auto found = reading.extra.find(name);
    line += (found == reading.extra.end() ? "" : QuoteCsv(found->second)) + ',';
  }
  line.back() = '\n';
  return line;
}

}  // namespace

void WriteReadingsCsv(const std::vector<Reading>& readings, std::ostream& out) {
  const std::vector<ReadingColumn> columns = ColumnsFor(readings);
  const std::set<std::string> extra = ExtraColumns(readings);
  std::string header;
  for (const ReadingColumn& column : columns) header += column.name + ',';
  for (const std::string& name : extra) header += QuoteCsv(name) + ',';
  header.back() = '\n';
  out << header;
  for (const Reading& reading : readings) out << PrintRow(reading, columns, extra);
}

void WriteReadingsCsv(const std::vector<Reading>& readings, const std::string& path) {
  std::ofstream out(path);
  WriteReadingsCsv(readings, out);
  if (!out.flush()) throw BenchError(path + ": the file cannot be written");
}

std::string BenchOf(const std::vector<Reading>& readings) {
  const auto has = [&](const auto& value) {
    return std::any_of(readings.begin(), readings.end(),
                       [&](const Reading& reading) { return std::isfinite(value(reading)); });
  };
  if (has([](const Reading& r) { return r.head_rad; })) return kHobBench;
  const bool two_tables = has([](const Reading& r) { return r.target_rad; });
  if (!two_tables) return has([](const Reading& r) { return r.reference_rad; }) ? kEncoderBench : kRotaryBench;
  // The autocollimator of the rotary bench is read beside the PSDs.
  const bool turntable = has([](const Reading& r) { return r.autocollimator_yaw_rad; }) &&
                         !has([](const Reading& r) { return r.mean_V[0]; });
  return turntable ? kTurntableBench : kRotaryBench;
}

std::vector<Reading> ParseReadingsCsv(std::istream& in, const std::string& name, const std::string& stated_bench) {
  const CsvTable table = ParseCsv(in, name);
  const std::string bench = stated_bench.empty() ? BenchOfColumns(table) : stated_bench;
  const std::vector<ReadingColumn> columns = Columns(bench);
  RequireColumns(table, columns, bench);
  std::vector<Reading> readings;
  std::set<int> numbers;
  for (const CsvTable::Row& row : table.rows) {
    const Reading reading = ParseRow(table, row, columns, bench);
    CheckOrder(table, row, reading, readings.empty() ? Time::min() : readings.back().time, numbers);
    readings.push_back(reading);
  }
  if (bench == kTurntableBench) CountBothTheSameWay(readings);
  return readings;
}

std::vector<Reading> ReadReadingsCsv(const std::string& path, const std::string& bench) {
  std::ifstream in(path);
  if (!in) throw InputError(path, "the file cannot be opened", "a readable readings.csv");
  return ParseReadingsCsv(in, path, bench);
}

}  // namespace twinbench
