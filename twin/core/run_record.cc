#include "twin/core/run_record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/sqlite_database.h"

namespace twinbench {
namespace {

constexpr int kApplicationId = 0x54574E42;  // "TWNB"
constexpr int kVersion = 2;                 // of the tables below

constexpr const char* kTables = R"sql(
CREATE TABLE provenance(program_version TEXT, bench TEXT, seed TEXT, clock_origin_utc TEXT);
CREATE TABLE readings(
  id INTEGER PRIMARY KEY, reading INTEGER NOT NULL UNIQUE, time_ns INTEGER NOT NULL, setup INTEGER, pass INTEGER,
  direction INTEGER, position INTEGER, phase TEXT NOT NULL, status TEXT NOT NULL,
  target_rad REAL, reference_rad REAL,
  psd_a_x_V REAL, psd_a_y_V REAL, psd_b_x_V REAL, psd_b_y_V REAL,
  psd_a_x_std_V REAL, psd_a_y_std_V REAL, psd_b_x_std_V REAL, psd_b_y_std_V REAL,
  n_samples INTEGER, dwell_s REAL, temperature_degC REAL,
  autocollimator_yaw_rad REAL, autocollimator_tilt_rad REAL, extra TEXT,
  measured_rad REAL, velocity_rad_s REAL);
CREATE TABLE raw_blocks(reading INTEGER PRIMARY KEY REFERENCES readings(reading), channels INTEGER, samples BLOB);
CREATE TABLE events(id INTEGER PRIMARY KEY, time_ns INTEGER NOT NULL, device TEXT, text TEXT);
CREATE TABLE finished(id INTEGER PRIMARY KEY CHECK(id = 1));
)sql";

constexpr const char* kInsertReading =
    "INSERT INTO readings VALUES(NULL, ?,?,?,?,?,?,?,?, ?,?, ?,?,?,?, ?,?,?,?, ?,?,?, ?,?, ?, ?,?)";

std::string RecordPath(const std::string& directory) {
  return (std::filesystem::path(directory) / "record.sqlite").string();
}

/// Nothing of a record may be changed or taken away once it is in.
void ForbidChanges(SqliteDatabase& database) {
  for (const char* table : {"provenance", "readings", "raw_blocks", "events", "finished"}) {
    for (const char* change : {"UPDATE", "DELETE"}) {
      const std::string sql = fmt::format(
          "CREATE TRIGGER no_{0}_{1} BEFORE {0} ON {1} BEGIN SELECT RAISE(ABORT, 'a run record is insert-only'); "
          "END",
          change, table);
      database.Execute(sql.c_str());
    }
  }
}

/// Write-ahead log, and the disk has it before a commit returns.
void MakeSafe(SqliteDatabase& database) {
  database.Execute("PRAGMA journal_mode = WAL");
  database.Execute("PRAGMA synchronous = FULL");
}

/// Makes the disk keep that the files are in the directory.
void SyncDirectory(const std::string& directory) {
  const int handle = open(directory.c_str(), O_RDONLY | O_DIRECTORY);
  const bool synced = handle >= 0 && fsync(handle) == 0;
  if (handle >= 0) close(handle);
  if (!synced) throw BenchError(directory + ": the disk does not confirm the new record");
}

void WriteProvenance(SqliteDatabase& database, const Provenance& provenance) {
  SqliteStatement insert(database, "INSERT INTO provenance VALUES(?, ?, ?, ?)");
  insert.Bind(0, provenance.program_version);
  insert.Bind(1, provenance.bench);
  insert.Bind(2, fmt::format("{}", provenance.seed));
  insert.Bind(3, provenance.clock_origin_utc);
  insert.Run();
}

void MakeTables(SqliteDatabase& database, const Provenance& provenance) {
  SqliteTransaction transaction(database);
  database.Execute(kTables);
  ForbidChanges(database);
  WriteProvenance(database, provenance);
  database.Execute(fmt::format("PRAGMA application_id = {}", kApplicationId).c_str());
  database.Execute(fmt::format("PRAGMA user_version = {}", kVersion).c_str());
  transaction.Commit();
}

/// Version 1 knew the rotary bench only: the columns of the angle comparison are added, empty.
void BringUpToDate(SqliteDatabase& database) {
  if (database.Ask("PRAGMA user_version") != "1") return;
  SqliteTransaction transaction(database);
  for (const char* column : {"measured_rad", "velocity_rad_s"})
    database.Execute(fmt::format("ALTER TABLE readings ADD COLUMN {} REAL", column).c_str());
  database.Execute(fmt::format("PRAGMA user_version = {}", kVersion).c_str());
  transaction.Commit();
}

/// @throws InputError unless the file is a whole record of a version that we know.
void CheckRecord(SqliteDatabase& database) {
  const std::string expected = "a record.sqlite made by twinbench";
  if (database.Ask("PRAGMA application_id") != fmt::format("{}", kApplicationId))
    throw InputError(database.path(), "this is a database of another program, or its making was interrupted",
                     expected);
  BringUpToDate(database);
  const std::string version = database.Ask("PRAGMA user_version");
  if (version != fmt::format("{}", kVersion))
    throw InputError(database.path(), "the record has version " + version, fmt::format("version {}", kVersion));
  const std::string check = database.Ask("PRAGMA quick_check(1)");
  if (check != "ok") throw InputError(database.path(), "the record is damaged: " + check, expected);
}

/// Text that is no UTF-8 (from an imported file) keeps its place, not its odd bytes.
std::string ExtraText(const Reading& reading) {
  if (reading.extra.empty()) return "";
  return nlohmann::json(reading.extra).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void BindReading(SqliteStatement& insert, const Reading& r) {
  int index = 0;
  const auto bind = [&](const auto& value) { insert.Bind(index++, value); };
  const auto bind_integer = [&](std::int64_t value) { insert.Bind(index++, value); };
  bind_integer(r.reading);
  bind_integer(r.time.time_since_epoch().count());
  for (const int number : {r.setup, r.pass, r.direction, r.position}) bind_integer(number);
  bind(std::string(PhaseName(r.phase)));
  bind(std::string(ReadingStatusName(r.status)));
  for (const double angle_rad : {r.target_rad, r.reference_rad}) bind(angle_rad);
  for (const double mean_V : r.mean_V) bind(mean_V);
  for (const double std_V : r.std_V) bind(std_V);
  bind_integer(r.n_samples);
  for (const double value : {r.dwell_s, r.temperature_degC, r.autocollimator_yaw_rad, r.autocollimator_tilt_rad})
    bind(value);
  bind(ExtraText(r));
  for (const double value : {r.measured_rad, r.velocity_rad_s}) bind(value);
}

/// @throws InputError if a name or the JSON in a row is none of ours.
Reading TakeReading(const SqliteStatement& row, const std::string& path) {
  Reading r;
  int column = 1;  // behind the id
  const auto take_integer = [&] { return static_cast<int>(row.Integer(column++)); };
  const auto take_real = [&] { return row.Real(column++); };
  r.reading = take_integer();
  r.time = Time(Duration(row.Integer(column++)));
  for (int* number : {&r.setup, &r.pass, &r.direction, &r.position}) *number = take_integer();
  const auto phase = PhaseOf(row.Text(column++));
  const auto status = ReadingStatusOf(row.Text(column++));
  for (double* angle_rad : {&r.target_rad, &r.reference_rad}) *angle_rad = take_real();
  for (double& mean_V : r.mean_V) mean_V = take_real();
  for (double& std_V : r.std_V) std_V = take_real();
  r.n_samples = take_integer();
  for (double* value : {&r.dwell_s, &r.temperature_degC, &r.autocollimator_yaw_rad, &r.autocollimator_tilt_rad})
    *value = take_real();
  const std::string extra_text = row.Text(column++);
  for (double* value : {&r.measured_rad, &r.velocity_rad_s}) *value = take_real();
  const auto extra = nlohmann::json::parse(extra_text, nullptr, false);
  if (!phase || !status || (extra.is_discarded() && !extra_text.empty()))
    throw InputError(path, fmt::format("reading {} of the record is damaged", r.reading), "names and JSON of ours");
  r.phase = *phase;
  r.status = *status;
  if (extra.is_object()) r.extra = extra.get<std::map<std::string, std::string>>();
  return r;
}

}  // namespace

/// The open file, with the statements that every reading needs.
struct RunRecord::Database : SqliteDatabase {
  using SqliteDatabase::SqliteDatabase;

  void Prepare() {
    insert_reading.emplace(*this, kInsertReading);
    insert_block.emplace(*this, "INSERT INTO raw_blocks VALUES(?, ?, ?)");
  }
  std::optional<SqliteStatement> insert_reading;  // as members they go before the base closes the file
  std::optional<SqliteStatement> insert_block;
};

RunRecord::RunRecord(std::unique_ptr<Database> database) : database_(std::move(database)) {}

RunRecord::~RunRecord() = default;

std::unique_ptr<RunRecord> RunRecord::Create(const std::string& directory, const Provenance& provenance) {
  const std::string path = RecordPath(directory);
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (std::filesystem::exists(directory) && !std::filesystem::is_directory(directory))
    throw InputError(directory, "this is a file", "a folder, or a name that is not taken");
  if (error) throw BenchError(fmt::format("{}: the folder cannot be made: {}", directory, error.message()));
  if (std::filesystem::exists(path)) throw InputError(path, "there is a record already", "a folder without one");
  // Made beside its place and renamed when whole: a record that is there can be opened, whenever the power fails.
  const std::string beside = path + ".part";
  for (const char* ending : {"", "-wal", "-shm"}) std::filesystem::remove(beside + ending, error);
  {
    Database made(beside, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    MakeSafe(made);
    MakeTables(made, provenance);
  }
  std::filesystem::rename(beside, path, error);
  if (error) throw BenchError(fmt::format("{}: the record cannot be made: {}", path, error.message()));
  SyncDirectory(directory);
  return Open(directory);
}

std::unique_ptr<RunRecord> RunRecord::Open(const std::string& directory) {
  const std::string path = RecordPath(directory);
  if (!std::filesystem::is_regular_file(path))
    throw InputError(directory, "there is no record.sqlite", "the folder of a run");
  try {
    auto database = std::make_unique<Database>(path, SQLITE_OPEN_READWRITE);
    CheckRecord(*database);
    MakeSafe(*database);
    database->Prepare();
    return std::unique_ptr<RunRecord>(new RunRecord(std::move(database)));
  } catch (const BenchError& failure) {  // SQLite's words, as bad input: nothing was run yet
    throw InputError(path, fmt::format("the record cannot be opened ({})", failure.what()), "an undamaged record");
  }
}

void RunRecord::Append(const Reading& reading, const Acquisition& taken) {
  SqliteTransaction transaction(*database_);
  SqliteStatement& insert = *database_->insert_reading;
  BindReading(insert, reading);
  insert.Run();
  if (!taken.raw.empty()) {
    SqliteStatement& block = *database_->insert_block;
    block.Bind(0, static_cast<std::int64_t>(reading.reading));
    block.Bind(1, static_cast<std::int64_t>(kChannels));
    block.Bind(2, std::span<const std::int16_t>(taken.raw));
    block.Run();
  }
  transaction.Commit();
}

void RunRecord::AppendEvent(Time time, const std::string& device, const std::string& text) {
  SqliteStatement insert(*database_, "INSERT INTO events VALUES(NULL, ?, ?, ?)");
  insert.Bind(0, static_cast<std::int64_t>(time.time_since_epoch().count()));
  insert.Bind(1, device);
  insert.Bind(2, text);
  insert.Run();
}

void RunRecord::Finish() {
  database_->Execute("INSERT OR IGNORE INTO finished VALUES(1)");
}

bool RunRecord::finished() const {
  return database_->Ask("SELECT count(*) FROM finished") == "1";
}

Provenance RunRecord::provenance() const {
  SqliteStatement select(*database_, "SELECT program_version, bench, seed, clock_origin_utc FROM provenance");
  const bool found = select.Step();
  const auto seed = found ? ParseSeed(select.Text(2)) : std::nullopt;
  if (!seed) throw InputError(database_->path(), "the record has no provenance", "an undamaged record");
  return {select.Text(0), select.Text(1), *seed, select.Text(3)};
}

std::vector<Reading> RunRecord::Readings() const {
  SqliteStatement select(*database_, "SELECT * FROM readings ORDER BY id");
  std::vector<Reading> readings;
  while (select.Step()) readings.push_back(TakeReading(select, database_->path()));
  return readings;
}

std::vector<RawBlock> RunRecord::RawBlocks() const {
  SqliteStatement select(*database_, "SELECT reading, channels, samples FROM raw_blocks ORDER BY rowid");
  std::vector<RawBlock> blocks;
  while (select.Step()) {
    const auto words = select.Words(2);
    blocks.push_back(
        {static_cast<int>(select.Integer(0)), static_cast<int>(select.Integer(1)), {words.begin(), words.end()}});
  }
  return blocks;
}

std::vector<RecordedEvent> RunRecord::Events() const {
  SqliteStatement select(*database_, "SELECT time_ns, device, text FROM events ORDER BY time_ns, id");
  std::vector<RecordedEvent> events;
  while (select.Step()) events.push_back({Time(Duration(select.Integer(0))), select.Text(1), select.Text(2)});
  return events;
}

}  // namespace twinbench
