#include "twin/core/record_digests.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "twin/core/digest.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/scenario.h"
#include "twin/core/whole_file.h"

namespace twinbench {
namespace {

constexpr const char* kScenario = "scenario.toml";

/// Every table of a record but the digests, with the key of its rows.
const std::map<std::string, std::string> kKeys = {{"provenance", "rowid"}, {"readings", "reading"}, {"raw_blocks", "reading"},
                                                  {"calls", "id"},         {"attempts", "id"},      {"events", "id"},
                                                  {"files", "id"},         {"finished", "id"}};

[[noreturn]] void FailNotAsWritten(const std::string& path, const std::string& what) {
  throw InputError(path, "the record is not as it was written: " + what, "the run as it was recorded, from a copy or made again");
}

std::string NameOf(const std::string& table, std::int64_t first, std::int64_t last) {
  if (table == "readings") return fmt::format("reading {}", first);
  if (table == "raw_blocks") return fmt::format("the raw block of reading {}", first);
  return first == last ? fmt::format("row {} of {}", first, table) : fmt::format("rows {} to {} of {}", first, last, table);
}

/// The first of them, and how many there are.
std::string InWords(const std::vector<std::string>& faults) {
  if (faults.size() == 1) return faults.front();
  return fmt::format("{}, and {} more parts altered, missing or added", faults.front(), faults.size() - 1);
}

std::string Link(const std::string& before, const std::string& table, std::int64_t first, std::int64_t last, const std::string& rows) {
  return Sha256(fmt::format("{}\n{} {} {}\n", before, table, first, last) + rows);
}

}  // namespace

RecordDigests::Rows RecordDigests::RowsOf(const std::string& table, std::int64_t first, std::int64_t last) {
  if (!selects_.contains(table))
    selects_.try_emplace(table, database_, fmt::format("SELECT * FROM {0} WHERE {1} BETWEEN ? AND ? ORDER BY {1}", table, kKeys.at(table)));
  SqliteStatement& select = selects_.at(table);
  select.Bind(0, first);
  select.Bind(1, last);
  Rows rows;
  for (; select.Step(); ++rows.count) rows.bytes += select.RowBytes();
  select.Reset();
  return rows;
}

/// Of files beside the record that have a digest.
std::vector<std::string> RecordDigests::Names() {
  std::vector<std::string> names;
  SqliteStatement select(database_, "SELECT DISTINCT name FROM files");
  while (select.Step()) names.push_back(select.Text(0));
  return names;
}

void RecordDigests::Seal(const std::string& table, std::int64_t first, std::int64_t last) {
  if (!insert_) {
    last_.emplace(database_, "SELECT digest FROM digests ORDER BY id DESC LIMIT 1");
    insert_.emplace(database_, "INSERT INTO digests VALUES(NULL, ?, ?, ?, ?)");
  }
  const std::string before = last_->Step() ? last_->Text(0) : "";
  last_->Reset();
  insert_->Bind(0, table);
  insert_->Bind(1, first);
  insert_->Bind(2, last);
  insert_->Bind(3, Link(before, table, first, last, RowsOf(table, first, last).bytes));
  insert_->Run();
}

void RecordDigests::SealAll() {
  for (const auto& [table, key] : kKeys) {
    SqliteStatement rows(database_, fmt::format("SELECT {} FROM {} ORDER BY rowid", key, table));
    while (rows.Step()) Seal(table, rows.Integer(0));
  }
}

void RecordDigests::CheckRows() {
  std::vector<std::string> faults;
  std::map<std::string, std::int64_t> found;
  SqliteStatement links(database_, "SELECT id, part, first, last, digest FROM digests ORDER BY id");
  std::string before;
  for (std::int64_t number = 1; links.Step(); ++number) {
    const std::string table = links.Text(1), digest = links.Text(4);
    const std::int64_t first = links.Integer(2), last = links.Integer(3);
    if (links.Integer(0) != number || !kKeys.contains(table)) FailNotAsWritten(database_.path(), fmt::format("digest {} missing", number));
    const Rows rows = RowsOf(table, first, last);
    found[table] += rows.count;
    if (digest != Link(before, table, first, last, rows.bytes))
      faults.push_back(NameOf(table, first, last) + (rows.count <= last - first ? " missing" : " altered"));
    before = digest;
  }
  for (const auto& [table, key] : kKeys) {
    const auto rows = ParseWholeNumber(database_.Ask(fmt::format("SELECT count(*) FROM {}", table).c_str()));
    if (rows != found[table]) faults.push_back(fmt::format("{} rows added to {}", rows.value_or(0) - found[table], table));
  }
  if (!faults.empty()) FailNotAsWritten(database_.path(), InWords(faults));
}

/// A file may be any that was written under its name: it is written after its digest, and the power may fail between.
void RecordDigests::CheckFiles(const std::map<std::string, std::string>& files) {
  std::vector<std::string> others;
  for (const auto& [name, bytes] : files) {
    SqliteStatement known(database_, "SELECT count(*) FROM files WHERE name = ? AND sha256 = ?");
    known.Bind(0, name);
    known.Bind(1, Sha256(bytes));
    known.Step();
    if (known.Integer(0) == 0) others.push_back(name);
  }
  if (!others.empty())
    FailNotAsWritten(database_.path(), fmt::format("altered, or of another run: {}", fmt::join(others, ", ")));
}

/// Of a scenario without a digest (an older version's, or one that came from elsewhere): whether it can be this run's.
void RecordDigests::CheckScenario(const std::string& folder) {
  const std::string path = folder + "/" + kScenario;
  if (!std::filesystem::is_regular_file(path)) return;
  SqliteStatement provenance(database_, "SELECT bench_name, seed FROM provenance");
  if (!provenance.Step() || provenance.Text(0).empty()) return;
  Scenario scenario;
  try {
    scenario = LoadScenario(path);
  } catch (const InputError&) {
    return;  // of another version, perhaps; whoever needs it says so
  }
  if (scenario.bench == provenance.Text(0) && fmt::format("{}", scenario.seed) == provenance.Text(1)) return;
  FailNotAsWritten(path, fmt::format("this is of the bench {} with seed {}, the record of {} with seed {}", scenario.bench, scenario.seed,
                                     provenance.Text(0), provenance.Text(1)));
}

void RecordDigests::Check(const std::string& folder) {
  const std::vector<std::string> names = Names();
  std::map<std::string, std::string> files;  // read before the record: what is written meanwhile has its digest in the record already
  for (const std::string& name : names) {
    if (std::filesystem::is_regular_file(folder + "/" + name)) files[name] = BytesOfFile(folder + "/" + name);
  }
  const SqliteTransaction one_moment(database_, "BEGIN");
  CheckRows();
  CheckFiles(files);
  if (std::ranges::find(names, kScenario) == names.end()) CheckScenario(folder);
}

}  // namespace twinbench
