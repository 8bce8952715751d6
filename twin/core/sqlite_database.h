#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <span>
#include <string>

namespace twinbench {

/// An SQLite file, closed at the end. Every failure is a DeviceFault kDisk with SQLite's own words.
class SqliteDatabase {
 public:
  /// @param flags  SQLITE_OPEN_...
  SqliteDatabase(const std::string& path, int flags);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  void Execute(const char* sql);
  /// The first column of the first row.
  std::string Ask(const char* sql);
  /// The key of the row that was inserted last.
  std::int64_t LastRow() const { return sqlite3_last_insert_rowid(handle_); }

  sqlite3* handle() const { return handle_; }
  const std::string& path() const { return path_; }
  [[noreturn]] void Fail() const;

 private:
  std::string path_;
  sqlite3* handle_ = nullptr;
};

/// A prepared statement. Parameters and columns count from 0; NaN is NULL.
class SqliteStatement {
 public:
  SqliteStatement(SqliteDatabase& database, const std::string& sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  void Bind(int index, std::int64_t value);
  void Bind(int index, double value);
  void Bind(int index, const std::string& value);
  void Bind(int index, std::span<const std::int16_t> value);  // as a blob, which must live until Step

  /// @return whether there is a row.
  bool Step();
  /// Carries out a statement without rows and makes it ready for the next values.
  void Run();
  /// Makes a statement whose rows were taken ready for the next values.
  void Reset();

  std::int64_t Integer(int column) const;
  double Real(int column) const;
  std::string Text(int column) const;
  std::span<const std::int16_t> Words(int column) const;  // until the next Step
  /// The row as bytes that are the same on every machine: name, type and value of each column that is not NULL. A column that a
  /// later version adds to an old row is NULL and changes nothing.
  std::string RowBytes() const;

 private:
  void Check(int code) const;

  SqliteDatabase& database_;
  sqlite3_stmt* handle_ = nullptr;
};

/// What is done until Commit is all done or not at all; undone at the end of its life without Commit.
class SqliteTransaction {
 public:
  /// @param begin  "BEGIN": to look only, at one moment of a record that another program is writing, which does not wait.
  explicit SqliteTransaction(SqliteDatabase& database, const char* begin = "BEGIN IMMEDIATE");
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void Commit();

 private:
  SqliteDatabase& database_;
  bool open_ = true;
};

}  // namespace twinbench
