#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "twin/campaign/trial.h"
#include "twin/core/sqlite_database.h"
#include "twin/core/writer_lock.h"

namespace twinbench::campaign {

/// A key that differs from trial to trial and is a number.
struct VariedKey {
  std::string name;
  std::map<std::int64_t, double> values;  // by trial
};

/// The results of a study in one SQLite file (docs/campaign.md): `provenance`, `trials` with the values of the
/// varied keys, and `results`, one row a number, because trials need not come to the same numbers. Each trial is
/// written in one transaction, or not at all, by one program at a time. Ordered by trial and name the content is the same whoever computed
/// it.
class Table {
 public:
  /// @throws InputError if the file is there already, or another program is making it.
  static Table Create(const std::string& path, const std::string& version, const Study& study);
  /// @throws InputError if it is not there, no table of a campaign, or of another study, scenario or version, or if
  ///         another program is writing it.
  static Table Continue(const std::string& path, const std::string& version, const Study& study);
  /// To be read, of any study.
  static Table Open(const std::string& path);

  void Write(const TrialRow& row, std::uint64_t seed, const std::vector<std::string>& values);

  /// Numbers of the trials that are in it, ascending.
  std::vector<std::int64_t> Done() const;
  /// Calls `look(row)` with every trial, ascending.
  void ForEach(const std::function<void(const TrialRow&)>& look) const;
  /// The varied keys whose values are numbers.
  std::vector<VariedKey> Varied() const;
  /// "version", "bench", "scenario" or "study", as the table was made; empty if it has no such thing.
  std::string Made(const std::string& name) const;
  /// A line a trial: number, seed, failure, verdict, varied keys, then value, u and error of every result.
  std::string Csv() const;

 private:
  explicit Table(std::unique_ptr<SqliteDatabase> database, std::optional<WriterLock> lock = {})
      : lock_(std::move(lock)), database_(std::move(database)) {}
  static Table Continue(const std::string& path, const std::string& version, const Study& study, WriterLock lock);
  std::vector<std::string> Keys() const;

  std::optional<WriterLock> lock_;  // of a table that is written
  std::unique_ptr<SqliteDatabase> database_;
};

}  // namespace twinbench::campaign
