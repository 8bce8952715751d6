#include "twin/core/run_record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "twin/core/device_fault.h"
#include "twin/core/digest.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_file.h"
#include "twin/core/number_text.h"
#include "twin/core/readable_record.h"
#include "twin/core/record_digests.h"
#include "twin/core/record_rows.h"
#include "twin/core/record_schema.h"
#include "twin/core/sqlite_database.h"
#include "twin/core/whole_file.h"
#include "twin/core/writer_lock.h"

namespace twinbench {
namespace {

constexpr const char* kInsertReading =
    "INSERT INTO readings VALUES(NULL, ?,?,?,?,?,?,?,?, ?,?, ?,?,?,?, ?,?,?,?, ?,?,?, ?,?, ?, ?,?, ?,?, ?)";
constexpr const char* kInsertBlock =
    "INSERT INTO raw_blocks(reading, channels, samples, first_scan, device_ns, host_ns, utc_ns, saturated_mask) "
    "VALUES(?,?,?, ?,?,?,?, ?)";
constexpr const char* kInsertCall =
    "INSERT INTO calls(reading, time_ns, device, request, answer) VALUES(?,?,?,?,?)";
constexpr const char* kInsertAttempt =
    "INSERT INTO attempts(reading, attempt, time_ns, fault, text) VALUES(?1, "
    "(SELECT coalesce(max(attempt), 0) + 1 FROM attempts WHERE reading = ?1), ?2, ?3, ?4)";
constexpr std::uint64_t kReserve_B = 4 << 20;

std::string RecordPath(const std::string& directory) {
  return (std::filesystem::path(directory) / "record.sqlite").string();
}

std::string LockPath(const std::string& directory) {
  return (std::filesystem::path(directory) / "record.lock").string();
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

}  // namespace

/// The open file, with the statements that every reading needs.
struct RunRecord::Database : private ReadableRecord, SqliteDatabase {  // in this order: a copy outlives its reader
  Database(const std::string& path, int flags)
      : ReadableRecord(path), SqliteDatabase(ReadableRecord::place(), flags) {}

  void Prepare() {
    insert_reading.emplace(*this, kInsertReading);
    insert_block.emplace(*this, kInsertBlock);
    insert_call.emplace(*this, kInsertCall);
  }
  /// Adds digests of rows of a table to the chain. Nobody can change a record in memory.
  void Seal(const std::string& table, std::int64_t first, std::int64_t last) {
    if (!folder.empty()) digests.Seal(table, first, last);
  }
  void AppendReading(const Reading& reading) {
    BindReading(*insert_reading, reading);
    insert_reading->Run();
    Seal("readings", reading.reading, reading.reading);
  }
  void AppendBlock(int reading, const Acquisition& taken) {
    largest_block_B = std::max<std::uint64_t>(largest_block_B, taken.raw.size() * sizeof(std::int16_t));
    insert_block->Bind(0, std::int64_t{reading});
    insert_block->Bind(1, std::int64_t{kChannels});
    insert_block->Bind(2, std::span<const std::int16_t>(taken.raw));
    const BlockStamp& stamp = taken.stamp;
    int column = 3;
    for (const std::int64_t number : {stamp.first_scan, stamp.device_ns, stamp.host_ns, stamp.utc_ns})
      insert_block->Bind(column++, number);
    insert_block->Bind(column, std::int64_t{taken.saturated_mask});
    insert_block->Run();
    Seal("raw_blocks", reading, reading);
  }
  void AppendCalls(int reading) {
    std::int64_t first = 0;
    for (const DeviceCall& call : calls) {
      insert_call->Bind(0, std::int64_t{reading});
      insert_call->Bind(1, std::int64_t{call.time.time_since_epoch().count()});
      insert_call->Bind(2, call.device);
      insert_call->Bind(3, call.request);
      insert_call->Bind(4, call.answer);
      insert_call->Run();
      if (first == 0) first = LastRow();
    }
    if (!calls.empty()) Seal("calls", first, LastRow());
  }
  /// One row, in a transaction of its own.
  void Insert(const std::string& table, SqliteStatement& insert) {
    SqliteTransaction transaction(*this);
    insert.Run();
    Seal(table, LastRow(), LastRow());
    transaction.Commit();
  }
  std::optional<SqliteStatement> insert_reading;  // as members they go before the base closes the file
  std::optional<SqliteStatement> insert_block, insert_call;
  std::optional<WriterLock> lock;
  RecordDigests digests{*this};
  std::string folder;             // of the record and the files beside it; empty: in memory
  std::vector<DeviceCall> calls;  // since the last reading
  std::uint64_t largest_block_B = 0;
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
  WriterLock making(LockPath(directory), path);
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
  auto record = Open(directory);
  record->database_->lock.emplace(std::move(making));
  return record;
}

std::unique_ptr<RunRecord> RunRecord::CreateInMemory(const Provenance& provenance) {
  auto database = std::make_unique<Database>(":memory:", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  MakeTables(*database, provenance);
  database->Prepare();
  return std::unique_ptr<RunRecord>(new RunRecord(std::move(database)));
}

std::unique_ptr<RunRecord> RunRecord::Open(const std::string& directory) {
  const std::string path = RecordPath(directory);
  if (!std::filesystem::exists(directory)) throw NothingToRead(directory, "the folder of a run");
  if (!std::filesystem::is_regular_file(path))
    throw InputError(directory, "there is no record.sqlite in it", "the folder of a run");
  try {
    auto database = std::make_unique<Database>(path, SQLITE_OPEN_READWRITE);
    database->folder = directory;
    CheckRecord(*database, directory);
    MakeSafe(*database);
    database->digests.Check(directory);
    database->Prepare();
    return std::unique_ptr<RunRecord>(new RunRecord(std::move(database)));
  } catch (const BenchError& failure) {  // SQLite's words, as bad input: nothing was run yet
    throw InputError(path, fmt::format("the record cannot be opened ({})", failure.what()), "an undamaged record");
  }
}

std::unique_ptr<RunRecord> RunRecord::Continue(const std::string& directory) {
  auto record = Open(directory);
  if (record->database_->path() != RecordPath(directory))
    throw InputError(directory, "the record cannot be written", "a folder that can, to go on in");
  record->database_->lock.emplace(LockPath(directory), RecordPath(directory));
  return record;
}

void RunRecord::SpareTheDisk() {
  database_->Execute("PRAGMA synchronous = NORMAL");
}

void RunRecord::Append(const Reading& reading, const Acquisition& taken) {
  SqliteTransaction transaction(*database_);
  database_->AppendReading(reading);
  if (!taken.raw.empty()) database_->AppendBlock(reading.reading, taken);
  database_->AppendCalls(reading.reading);
  transaction.Commit();
  database_->calls.clear();
  if (listener_) listener_(reading);
}

void RunRecord::AppendAll(const std::vector<Reading>& readings) {
  SqliteTransaction transaction(*database_);
  for (const Reading& reading : readings) {
    database_->AppendReading(reading);
    database_->AppendCalls(reading.reading);
    database_->calls.clear();
  }
  transaction.Commit();
  if (!listener_) return;
  for (const Reading& reading : readings) listener_(reading);
}

void RunRecord::Called(const DeviceCall& call) {
  database_->calls.push_back(call);
}

void RunRecord::ForgetCalls() {
  database_->calls.clear();
}

void RunRecord::AttemptFailed(int reading, Time time, const std::string& fault, const std::string& text) {
  SqliteStatement insert(*database_, kInsertAttempt);
  insert.Bind(0, std::int64_t{reading});
  insert.Bind(1, std::int64_t{time.time_since_epoch().count()});
  insert.Bind(2, fault);
  insert.Bind(3, text);
  database_->Insert("attempts", insert);
}

void RunRecord::RequireRoom() {
  struct statvfs disk {};
  if (statvfs(database_->path().c_str(), &disk) != 0) return;  // a file system that does not tell
  const std::uint64_t free_B = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free_B >= kReserve_B + 2 * database_->largest_block_B) return;
  throw DeviceFault(FaultKind::kDisk, database_->path(),
                    fmt::format("{:.1f} MB are left on the disk; the run pauses before a reading is lost",
                                static_cast<double>(free_B) / 1e6));
}

void RunRecord::AppendEvent(Time time, const std::string& device, const std::string& text) {
  SqliteStatement insert(*database_, "INSERT INTO events VALUES(NULL, ?, ?, ?)");
  insert.Bind(0, static_cast<std::int64_t>(time.time_since_epoch().count()));
  insert.Bind(1, device);
  insert.Bind(2, text);
  database_->Insert("events", insert);
}

void RunRecord::WriteBeside(const std::string& name, const std::string& text) {
  SqliteStatement insert(*database_, "INSERT INTO files VALUES(NULL, ?, ?)");
  insert.Bind(0, name);
  insert.Bind(1, Sha256(text));
  database_->Insert("files", insert);
  WriteFileAtOnce(database_->folder + "/" + name, text);
}

void RunRecord::Finish() {
  database_->Execute("PRAGMA synchronous = FULL");  // this commit takes all before it to the disk
  SqliteTransaction transaction(*database_);
  database_->AppendCalls(-1);  // behind the last reading
  if (!finished()) {
    database_->Execute("INSERT INTO finished VALUES(1)");
    database_->Seal("finished", 1, 1);
  }
  transaction.Commit();
  database_->calls.clear();
}

bool RunRecord::HasWriter(const std::string& directory) {
  return WriterLock::IsHeld(LockPath(directory));
}

bool RunRecord::finished() const {
  return database_->Ask("SELECT count(*) FROM finished") == "1";
}

Provenance RunRecord::provenance() const {
  SqliteStatement select(*database_,
                         "SELECT program_version, bench, seed, clock_origin_utc, bench_name FROM provenance");
  const bool found = select.Step();
  const auto seed = found ? ParseSeed(select.Text(2)) : std::nullopt;
  if (!seed) throw InputError(database_->path(), "the record has no provenance", "an undamaged record");
  return {select.Text(0), select.Text(1), *seed, select.Text(3), select.Text(4)};
}

std::vector<Reading> RunRecord::Readings() const {
  SqliteStatement select(*database_, "SELECT * FROM readings ORDER BY id");
  std::vector<Reading> readings;
  while (select.Step()) readings.push_back(TakeReading(select, database_->path()));
  return readings;
}

std::vector<RawBlock> RunRecord::RawBlocks() const {
  SqliteStatement select(*database_,
                         "SELECT reading, channels, samples, coalesce(first_scan, -1), coalesce(device_ns, -1), "
                         "coalesce(host_ns, -1), coalesce(utc_ns, -1), coalesce(saturated_mask, 0) "
                         "FROM raw_blocks ORDER BY rowid");
  std::vector<RawBlock> blocks;
  while (select.Step()) {
    const auto words = select.Words(2);
    const auto integer = [&](int column) { return static_cast<int>(select.Integer(column)); };
    blocks.push_back({integer(0),
                      integer(1),
                      {words.begin(), words.end()},
                      {select.Integer(3), select.Integer(4), select.Integer(5), select.Integer(6)},
                      integer(7)});
  }
  return blocks;
}

std::vector<DeviceCall> RunRecord::Calls() const {
  SqliteStatement select(*database_, "SELECT time_ns, device, request, answer FROM calls ORDER BY id");
  std::vector<DeviceCall> calls;
  while (select.Step())
    calls.push_back({Time(Duration(select.Integer(0))), select.Text(1), select.Text(2), select.Text(3)});
  return calls;
}

std::vector<FailedAttempt> RunRecord::FailedAttempts() const {
  SqliteStatement select(*database_, "SELECT reading, attempt, time_ns, fault, text FROM attempts ORDER BY id");
  std::vector<FailedAttempt> attempts;
  while (select.Step()) {
    attempts.push_back({static_cast<int>(select.Integer(0)), static_cast<int>(select.Integer(1)),
                        Time(Duration(select.Integer(2))), select.Text(3), select.Text(4)});
  }
  return attempts;
}

std::vector<RecordedEvent> RunRecord::Events() const {
  SqliteStatement select(*database_, "SELECT time_ns, device, text FROM events ORDER BY time_ns, id");
  std::vector<RecordedEvent> events;
  while (select.Step()) events.push_back({Time(Duration(select.Integer(0))), select.Text(1), select.Text(2)});
  return events;
}

}  // namespace twinbench
