#include "twin/core/record_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>

#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/record_digests.h"
#include "twin/core/record_rows.h"
#include "twin/core/scenario.h"

namespace twinbench {
namespace {

constexpr int kApplicationId = 0x54574E42;  // "TWNB"
constexpr int kVersion = 6;                 // of the tables below

constexpr const char* kTables = R"sql(
CREATE TABLE provenance(program_version TEXT, bench TEXT, seed TEXT, clock_origin_utc TEXT, bench_name TEXT);
CREATE TABLE readings(
  id INTEGER PRIMARY KEY, reading INTEGER NOT NULL UNIQUE, time_ns INTEGER NOT NULL, setup INTEGER, pass INTEGER,
  direction INTEGER, position INTEGER, phase TEXT NOT NULL, status TEXT NOT NULL,
  target_rad REAL, reference_rad REAL,
  psd_a_x_V REAL, psd_a_y_V REAL, psd_b_x_V REAL, psd_b_y_V REAL,
  psd_a_x_std_V REAL, psd_a_y_std_V REAL, psd_b_x_std_V REAL, psd_b_y_std_V REAL,
  n_samples INTEGER, dwell_s REAL, temperature_degC REAL,
  autocollimator_yaw_rad REAL, autocollimator_tilt_rad REAL, extra TEXT,
  measured_rad REAL, velocity_rad_s REAL, head_rad REAL, interferometer_rad REAL, quantities TEXT);
CREATE TABLE raw_blocks(reading INTEGER PRIMARY KEY REFERENCES readings(reading), channels INTEGER, samples BLOB,
  first_scan INTEGER, device_ns INTEGER, host_ns INTEGER, utc_ns INTEGER, saturated_mask INTEGER);
CREATE TABLE events(id INTEGER PRIMARY KEY, time_ns INTEGER NOT NULL, device TEXT, text TEXT);
CREATE TABLE finished(id INTEGER PRIMARY KEY CHECK(id = 1));
)sql";

/// Since version 3: what was asked of the devices on the way to each reading, and attempts that came to nothing.
constexpr const char* kJournalTables = R"sql(
CREATE TABLE calls(id INTEGER PRIMARY KEY, reading INTEGER NOT NULL, time_ns INTEGER NOT NULL, device TEXT NOT NULL,
  request TEXT NOT NULL, answer TEXT);
CREATE TABLE attempts(id INTEGER PRIMARY KEY, reading INTEGER NOT NULL, attempt INTEGER NOT NULL, time_ns INTEGER,
  fault TEXT, text TEXT, UNIQUE(reading, attempt));
)sql";

/// Since version 6: digests of all other rows, and of files beside the record.
constexpr const char* kDigestTables = R"sql(
CREATE TABLE digests(id INTEGER PRIMARY KEY, part TEXT NOT NULL, first INTEGER NOT NULL, last INTEGER NOT NULL,
  digest TEXT NOT NULL);
CREATE TABLE files(id INTEGER PRIMARY KEY, name TEXT NOT NULL, sha256 TEXT NOT NULL);
)sql";

/// Nothing of a record may be changed or taken away once it is in.
void ForbidChanges(SqliteDatabase& database, std::initializer_list<const char*> tables) {
  for (const char* table : tables) {
    for (const char* change : {"UPDATE", "DELETE"}) {
      const std::string sql = fmt::format(
          "CREATE TRIGGER no_{0}_{1} BEFORE {0} ON {1} BEGIN SELECT RAISE(ABORT, 'a run record is insert-only'); "
          "END",
          change, table);
      database.Execute(sql.c_str());
    }
  }
}

void WriteProvenance(SqliteDatabase& database, const Provenance& provenance) {
  SqliteStatement insert(database, "INSERT INTO provenance VALUES(?, ?, ?, ?, ?)");
  insert.Bind(0, provenance.program_version);
  insert.Bind(1, provenance.source);
  insert.Bind(2, fmt::format("{}", provenance.seed));
  insert.Bind(3, provenance.clock_origin_utc);
  insert.Bind(4, provenance.bench);
  insert.Run();
}

void AddColumns(SqliteDatabase& database, const char* table, const char* type,
                std::initializer_list<const char*> columns) {
  for (const char* column : columns)
    database.Execute(fmt::format("ALTER TABLE {} ADD COLUMN {} {}", table, column, type).c_str());
}

/// Version 1 knew the rotary bench only: the columns of the angle comparison are added, empty.
void FromVersion1(SqliteDatabase& database) {
  AddColumns(database, "readings", "REAL", {"measured_rad", "velocity_rad_s"});
}

/// Version 2 kept no calls, attempts and stamps of blocks.
void FromVersion2(SqliteDatabase& database) {
  AddColumns(database, "raw_blocks", "INTEGER", {"first_scan", "device_ns", "host_ns", "utc_ns", "saturated_mask"});
  database.Execute(kJournalTables);
  ForbidChanges(database, {"calls", "attempts"});
}

/// Version 3 knew no hobbing machine.
void FromVersion3(SqliteDatabase& database) {
  AddColumns(database, "readings", "REAL", {"head_rad", "interferometer_rad"});
}

/// The bench that the run's scenario names; empty if there is no scenario, or none that can be read.
std::string BenchOfScenario(const std::string& folder) {
  const std::string scenario = std::filesystem::path(folder) / "scenario.toml";
  try {
    return std::filesystem::exists(scenario) ? BenchOfScenarioFile(scenario) : "";
  } catch (const InputError&) {
    return "";
  }
}

/// The bench that has the columns of which these readings have values; empty if they have none.
std::string BenchOfReadings(SqliteDatabase& database) {
  std::vector<Reading> readings;
  SqliteStatement select(database, "SELECT * FROM readings ORDER BY id");
  while (select.Step()) readings.push_back(TakeReading(select, database.path()));
  const BenchFormat* format = FormatByColumns([&](const ReadingColumn& column) {
    return std::ranges::any_of(readings, [&](const Reading& r) { return !column.print(r).empty(); });
  });
  return format ? format->name : "";
}

/// Version 4 knew the quantities of four benches and did not say of which it was. Nothing in a record may be
/// changed, but a new column may have a value for the row that is there.
void FromVersion4(SqliteDatabase& database, const std::string& folder) {
  AddColumns(database, "readings", "TEXT", {"quantities"});
  std::string bench = BenchOfScenario(folder);
  if (bench.empty()) bench = BenchOfReadings(database);
  AddColumns(database, "provenance", fmt::format("TEXT DEFAULT '{}'", bench).c_str(), {"bench_name"});
}

/// Version 5 had no digests: what is altered from now on is told.
void AddDigests(SqliteDatabase& database) {
  database.Execute(kDigestTables);
  ForbidChanges(database, {"digests", "files"});
  RecordDigests(database).SealAll();
}

void BringUpToDate(SqliteDatabase& database, const std::string& folder) {
  const auto version = ParseWholeNumber(database.Ask("PRAGMA user_version")).value_or(0);
  if (version < 1 || version >= kVersion) return;
  SqliteTransaction transaction(database);
  if (version < 2) FromVersion1(database);
  if (version < 3) FromVersion2(database);
  if (version < 4) FromVersion3(database);
  if (version < 5) FromVersion4(database, folder);
  AddDigests(database);
  database.Execute(fmt::format("PRAGMA user_version = {}", kVersion).c_str());
  transaction.Commit();
}

}  // namespace

void MakeTables(SqliteDatabase& database, const Provenance& provenance) {
  SqliteTransaction transaction(database);
  database.Execute(kTables);
  database.Execute(kJournalTables);
  ForbidChanges(database, {"provenance", "readings", "raw_blocks", "events", "finished", "calls", "attempts"});
  WriteProvenance(database, provenance);
  AddDigests(database);
  database.Execute(fmt::format("PRAGMA application_id = {}", kApplicationId).c_str());
  database.Execute(fmt::format("PRAGMA user_version = {}", kVersion).c_str());
  transaction.Commit();
}

void CheckRecord(SqliteDatabase& database, const std::string& folder) {
  const std::string expected = "a record.sqlite made by twinbench";
  if (database.Ask("PRAGMA application_id") != fmt::format("{}", kApplicationId))
    throw InputError(database.path(), "this is a database of another program, or its making was interrupted",
                     expected);
  BringUpToDate(database, folder);
  const std::string version = database.Ask("PRAGMA user_version");
  if (version != fmt::format("{}", kVersion))
    throw InputError(database.path(), "the record has version " + version, fmt::format("version {}", kVersion));
  const std::string check = database.Ask("PRAGMA quick_check(1)");
  if (check != "ok") throw InputError(database.path(), "the record is damaged: " + check, expected);
}

}  // namespace twinbench
