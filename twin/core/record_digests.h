#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/sqlite_database.h"

/// The chain of digests that tells whether a record is still as it was written. Private to run_record.cc.
namespace twinbench {

/// Each link is the SHA-256 of the link before it and of rows that the same transaction wrote: no row can be changed, taken away,
/// added or put elsewhere without a link that does not fit. It shows accidents and what is done by hand; whoever makes a whole new
/// chain makes a new record.
class RecordDigests {
 public:
  explicit RecordDigests(SqliteDatabase& database) : database_(database) {}

  /// Every row that is there, each with a link of its own: of a new record, or of one of a version without digests.
  void SealAll();
  /// Rows of a table, with keys (number of the reading, or id) from first to last, inside the transaction that wrote them.
  void Seal(const std::string& table, std::int64_t first, std::int64_t last);
  void Seal(const std::string& table, std::int64_t row) { Seal(table, row, row); }

  /// @param folder  Of the record, with the files beside it.
  /// @throws InputError that says what is altered, missing or added.
  void Check(const std::string& folder);

 private:
  struct Rows {
    std::string bytes;
    std::int64_t count = 0;
  };
  Rows RowsOf(const std::string& table, std::int64_t first, std::int64_t last);
  std::vector<std::string> Names();
  void CheckRows();
  /// @param files  Their bytes, by name.
  void CheckFiles(const std::map<std::string, std::string>& files);
  void CheckScenario(const std::string& folder);

  SqliteDatabase& database_;
  std::map<std::string, SqliteStatement> selects_;  // by table
  std::optional<SqliteStatement> last_, insert_;
};

}  // namespace twinbench
