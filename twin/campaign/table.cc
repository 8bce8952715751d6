#include "twin/campaign/table.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "twin/core/digest.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_file.h"
#include "twin/core/number_text.h"

namespace twinbench::campaign {
namespace {

constexpr int kTableId = 0x7442434D;  // "tBCM"
constexpr const char* kExpected = "a table made by twinbench campaign";
constexpr const char* kAskRows =
    "SELECT t.trial, t.failure, t.verdict, r.name, r.value, r.u, r.error, r.k FROM trials t "
    "LEFT JOIN results r USING(trial) ORDER BY t.trial, r.name";

/// A name as SQL takes it, whatever is in it.
std::string Quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

std::vector<std::pair<std::string, std::string>> ProvenanceOf(const std::string& version, const Study& study) {
  const Scenario scenario = study.With({});
  return {{"version", version},
          {"bench", scenario.bench},
          {"study", study.text},
          {"scenario", WriteScenario(scenario)}};
}

void MakeCampaignTables(SqliteDatabase& database, const std::string& version, const Study& study) {
  SqliteTransaction transaction(database);
  std::string keys;
  for (const Variation& variation : study.vary) keys += ", " + Quoted(variation.key) + " TEXT NOT NULL";
  database.Execute("CREATE TABLE provenance(name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID");
  database.Execute(
      fmt::format("CREATE TABLE trials(trial INTEGER PRIMARY KEY, seed TEXT NOT NULL, failure TEXT NOT "
                  "NULL, verdict TEXT NOT NULL{})",
                  keys)
          .c_str());
  database.Execute(
      "CREATE TABLE results(trial INTEGER NOT NULL, name TEXT NOT NULL, value REAL, u REAL, error REAL, k REAL, "
      "PRIMARY KEY(trial, name)) WITHOUT ROWID");
  database.Execute("CREATE TABLE digests(trial INTEGER PRIMARY KEY, digest TEXT NOT NULL)");
  SqliteStatement insert(database, "INSERT INTO provenance VALUES(?, ?)");
  for (const auto& [name, value] : ProvenanceOf(version, study)) {
    insert.Bind(0, name);
    insert.Bind(1, value);
    insert.Run();
  }
  database.Execute(fmt::format("PRAGMA application_id = {}", kTableId).c_str());
  transaction.Commit();
}

/// Of a trial with its values and results; prepared once for all that are asked for.
class TrialDigests {
 public:
  explicit TrialDigests(SqliteDatabase& database)
      : trial_(database, "SELECT * FROM trials WHERE trial = ?"),
        results_(database, "SELECT * FROM results WHERE trial = ? ORDER BY name") {}

  std::string Of(std::int64_t trial) {
    std::string bytes;
    for (SqliteStatement* rows : {&trial_, &results_}) {
      rows->Bind(0, trial);
      while (rows->Step()) bytes += rows->RowBytes();
      rows->Reset();
    }
    return Sha256(bytes);
  }

 private:
  SqliteStatement trial_, results_;
};

/// Trials as they were written, none taken away or added. (Tables of versions before the digests have nothing to tell it by.)
void RequireUnaltered(SqliteDatabase& database) {
  const SqliteTransaction at_one_moment(database, "BEGIN");  // another program may be writing
  if (database.Ask("SELECT count(*) FROM sqlite_master WHERE name = 'digests'") == "0") return;
  SqliteStatement ask(database,
                      "SELECT n.trial, d.digest FROM (SELECT trial FROM trials UNION SELECT trial FROM results UNION "
                      "SELECT trial FROM digests) n LEFT JOIN digests d USING(trial) ORDER BY n.trial");
  TrialDigests digests(database);
  while (ask.Step()) {
    if (const std::int64_t trial = ask.Integer(0); digests.Of(trial) != ask.Text(1))
      throw InputError(database.path(), fmt::format("trial {} is not as it was written", trial),
                       "the table as the campaign left it, from a copy or made again");
  }
}

/// What was written survives kill -9; a power failure may cost the last trials, which are then done again.
void MakeCampaignSafe(SqliteDatabase& database) {
  database.Execute("PRAGMA journal_mode = WAL");
  database.Execute("PRAGMA synchronous = NORMAL");
}

void RequireTable(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw NothingToRead(path, kExpected);
}

std::unique_ptr<SqliteDatabase> OpenTable(const std::string& path, int flags) {
  RequireTable(path);
  try {
    auto database = std::make_unique<SqliteDatabase>(path, flags);
    if (database->Ask("PRAGMA application_id") != fmt::format("{}", kTableId))
      throw InputError(path, "this is another kind of database", kExpected);
    RequireUnaltered(*database);
    return database;
  } catch (const BenchError& failure) {
    throw InputError(path, fmt::format("it cannot be opened ({})", failure.what()), kExpected);
  }
}

void RequireSame(SqliteDatabase& database, const std::string& version, const Study& study) {
  for (const auto& [name, value] : ProvenanceOf(version, study)) {
    SqliteStatement ask(database, "SELECT value FROM provenance WHERE name = ?");
    ask.Bind(0, name);
    if (!ask.Step() || ask.Text(0) != value)
      throw InputError(database.path(), "its trials have another " + name,
                       "the table of this study, or a new file");
  }
}

std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  return Quoted(text);
}

std::string CsvNumber(double value) {
  return std::isfinite(value) ? PrintInUnit(value, 1.0) : "";
}

/// Names of all results, ascending; the last says whether any trial has its error.
std::map<std::string, bool> ResultNames(SqliteDatabase& database) {
  std::map<std::string, bool> names;
  SqliteStatement ask(database, "SELECT name, count(error) FROM results GROUP BY name");
  while (ask.Step()) names[ask.Text(0)] = ask.Integer(1) > 0;
  return names;
}

std::string CsvResults(const TrialRow& row, const std::map<std::string, bool>& names) {
  std::string text;
  auto result = row.results.begin();
  for (const auto& [name, has_error] : names) {
    const bool has = result != row.results.end() && result->name == name;
    text += has ? fmt::format(",{},{}", CsvNumber(result->value), CsvNumber(result->u)) : ",,";
    if (has_error) text += "," + (has ? CsvNumber(result->error) : "");
    if (has) ++result;
  }
  return text;
}

/// Of the file itself, whatever link it is named by.
WriterLock LockOf(const std::string& path) {
  return {std::filesystem::weakly_canonical(path).string() + ".lock", path};
}

}  // namespace

Table Table::Create(const std::string& path, const std::string& version, const Study& study) {
  if (std::filesystem::exists(path))
    throw InputError(path, "the file is there already", "a new name, or --resume to go on with its study");
  WriterLock lock = LockOf(path);
  // Made beside its place and renamed when whole: a table that is there can be continued.
  const std::string beside = path + ".part";
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(beside + ending);
  {
    SqliteDatabase made(beside, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    MakeCampaignTables(made, version, study);
  }
  std::filesystem::rename(beside, path);
  return Continue(path, version, study, std::move(lock));
}

Table Table::Continue(const std::string& path, const std::string& version, const Study& study) {
  RequireTable(path);
  return Continue(path, version, study, LockOf(path));
}

Table Table::Continue(const std::string& path, const std::string& version, const Study& study, WriterLock lock) {
  auto database = OpenTable(path, SQLITE_OPEN_READWRITE);
  RequireSame(*database, version, study);
  MakeCampaignSafe(*database);
  return Table(std::move(database), std::move(lock));
}

Table Table::Open(const std::string& path) {
  return Table(OpenTable(path, SQLITE_OPEN_READWRITE));
}

void Table::Write(const TrialRow& row, std::uint64_t seed, const std::vector<std::string>& values) {
  SqliteTransaction transaction(*database_);
  std::string places;
  for (std::size_t k = 0; k < values.size(); ++k) places += ", ?";
  SqliteStatement trial(*database_, "INSERT INTO trials VALUES(?, ?, ?, ?" + places + ")");
  trial.Bind(0, row.trial);
  trial.Bind(1, fmt::format("{}", seed));
  trial.Bind(2, row.failure);
  trial.Bind(3, row.verdict);
  for (std::size_t k = 0; k < values.size(); ++k) trial.Bind(4 + static_cast<int>(k), values[k]);
  trial.Run();
  SqliteStatement result(*database_, "INSERT INTO results VALUES(?, ?, ?, ?, ?, ?)");
  for (const TrialResult& r : row.results) {
    result.Bind(0, row.trial);
    result.Bind(1, r.name);
    result.Bind(2, r.value);
    result.Bind(3, r.u);
    result.Bind(4, r.error);
    result.Bind(5, r.k);
    result.Run();
  }
  SqliteStatement digest(*database_, "INSERT INTO digests VALUES(?, ?)");
  digest.Bind(0, row.trial);
  digest.Bind(1, TrialDigests(*database_).Of(row.trial));
  digest.Run();
  transaction.Commit();
}

std::vector<std::int64_t> Table::Done() const {
  std::vector<std::int64_t> done;
  SqliteStatement ask(*database_, "SELECT trial FROM trials ORDER BY trial");
  while (ask.Step()) done.push_back(ask.Integer(0));
  return done;
}

void Table::ForEach(const std::function<void(const TrialRow&)>& look) const {
  SqliteStatement ask(*database_, kAskRows);
  TrialRow row;
  bool open = false;
  while (ask.Step()) {
    if (open && row.trial != ask.Integer(0)) {
      look(row);
      open = false;
    }
    if (!open) row = {ask.Integer(0), ask.Text(1), ask.Text(2), {}};
    open = true;
    if (const std::string name = ask.Text(3); !name.empty())
      row.results.push_back({name, ask.Real(4), ask.Real(5), ask.Real(6), ask.Real(7)});
  }
  if (open) look(row);
}

std::vector<std::string> Table::Keys() const {
  std::vector<std::string> keys;
  SqliteStatement ask(*database_, "SELECT name FROM pragma_table_info('trials') WHERE cid > 3 ORDER BY cid");
  while (ask.Step()) keys.push_back(ask.Text(0));
  return keys;
}

std::vector<VariedKey> Table::Varied() const {
  std::vector<VariedKey> varied;
  for (const std::string& key : Keys()) {
    VariedKey found{key, {}};
    SqliteStatement ask(*database_, fmt::format("SELECT trial, {} FROM trials", Quoted(key)));
    while (ask.Step()) {
      if (const auto number = ParseNumber(ask.Text(1))) found.values[ask.Integer(0)] = *number;
    }
    if (!found.values.empty()) varied.push_back(std::move(found));
  }
  return varied;
}

std::string Table::Made(const std::string& name) const {
  SqliteStatement ask(*database_, "SELECT value FROM provenance WHERE name = ?");
  ask.Bind(0, name);
  return ask.Step() ? ask.Text(0) : "";
}

std::string Table::Csv() const {
  const std::vector<std::string> keys = Keys();
  const std::map<std::string, bool> names = ResultNames(*database_);
  std::string text = "trial,seed,failure,verdict";
  for (const std::string& key : keys) text += "," + CsvText(key);
  for (const auto& [name, has_error] : names)
    text += fmt::format(",{0},u({0}){1}", name, has_error ? fmt::format(",error({})", name) : "");
  text += "\n";
  SqliteStatement ask(*database_, "SELECT * FROM trials ORDER BY trial");
  ForEach([&](const TrialRow& row) {
    ask.Step();
    text += fmt::format("{},{},{},{}", row.trial, ask.Text(1), CsvText(row.failure), row.verdict);
    for (std::size_t k = 0; k < keys.size(); ++k) text += "," + CsvText(ask.Text(4 + static_cast<int>(k)));
    text += CsvResults(row, names) + "\n";
  });
  return text;
}

}  // namespace twinbench::campaign
