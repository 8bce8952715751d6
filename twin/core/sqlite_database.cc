#include "twin/core/sqlite_database.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "twin/core/device_fault.h"
#include "twin/core/reading.h"

namespace twinbench {
namespace {

/// Low byte first.
void AppendWord(std::uint64_t word, std::string& bytes) {
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(word >> shift & 0xff);
}

}  // namespace

SqliteDatabase::SqliteDatabase(const std::string& path, int flags) : path_(path) {
  if (sqlite3_open_v2(path.c_str(), &handle_, flags, nullptr) == SQLITE_OK) {
    sqlite3_busy_timeout(handle_, 5000);  // somebody may be reading
    return;
  }
  const std::string reason = handle_ ? sqlite3_errmsg(handle_) : "out of memory";
  sqlite3_close(handle_);
  throw BenchError(fmt::format("{}: {}", path, reason));
}

SqliteDatabase::~SqliteDatabase() {
  sqlite3_close(handle_);
}

void SqliteDatabase::Fail() const {
  throw DeviceFault(FaultKind::kDisk, path_, sqlite3_errmsg(handle_));
}

void SqliteDatabase::Execute(const char* sql) {
  if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) Fail();
}

std::string SqliteDatabase::Ask(const char* sql) {
  SqliteStatement statement(*this, sql);
  return statement.Step() ? statement.Text(0) : "";
}

SqliteStatement::SqliteStatement(SqliteDatabase& database, const std::string& sql) : database_(database) {
  Check(sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &handle_, nullptr));
}

SqliteStatement::~SqliteStatement() {
  sqlite3_finalize(handle_);
}

void SqliteStatement::Check(int code) const {
  if (code != SQLITE_OK) database_.Fail();
}

void SqliteStatement::Bind(int index, std::int64_t value) {
  Check(sqlite3_bind_int64(handle_, index + 1, value));
}

void SqliteStatement::Bind(int index, double value) {
  Check(std::isnan(value) ? sqlite3_bind_null(handle_, index + 1) : sqlite3_bind_double(handle_, index + 1, value));
}

void SqliteStatement::Bind(int index, const std::string& value) {
  Check(sqlite3_bind_text64(handle_, index + 1, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

void SqliteStatement::Bind(int index, std::span<const std::int16_t> value) {
  Check(sqlite3_bind_blob64(handle_, index + 1, value.data(), value.size_bytes(), SQLITE_STATIC));
}

bool SqliteStatement::Step() {
  const int code = sqlite3_step(handle_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    const std::string reason = sqlite3_errmsg(database_.handle());
    sqlite3_reset(handle_);
    throw BenchError(fmt::format("{}: {}", database_.path(), reason));
  }
  return code == SQLITE_ROW;
}

void SqliteStatement::Run() {
  Step();
  Reset();
}

void SqliteStatement::Reset() {
  Check(sqlite3_reset(handle_));
}

std::int64_t SqliteStatement::Integer(int column) const {
  return sqlite3_column_int64(handle_, column);
}

double SqliteStatement::Real(int column) const {
  return sqlite3_column_type(handle_, column) == SQLITE_NULL ? kNaN : sqlite3_column_double(handle_, column);
}

std::string SqliteStatement::Text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))) : "";
}

std::span<const std::int16_t> SqliteStatement::Words(int column) const {
  const auto* words = static_cast<const std::int16_t*>(sqlite3_column_blob(handle_, column));
  return {words, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column)) / sizeof(std::int16_t)};
}

std::string SqliteStatement::RowBytes() const {
  std::string bytes;
  for (int column = 0; column < sqlite3_column_count(handle_); ++column) {
    const int type = sqlite3_column_type(handle_, column);
    if (type == SQLITE_NULL) continue;
    bytes += fmt::format("{}={}:", sqlite3_column_name(handle_, column), type);
    if (type == SQLITE_INTEGER) AppendWord(static_cast<std::uint64_t>(sqlite3_column_int64(handle_, column)), bytes);
    if (type == SQLITE_FLOAT) AppendWord(std::bit_cast<std::uint64_t>(sqlite3_column_double(handle_, column)), bytes);
    if (type != SQLITE_TEXT && type != SQLITE_BLOB) continue;
    const auto* value = static_cast<const char*>(sqlite3_column_blob(handle_, column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_, column));
    AppendWord(size, bytes);
    if (size > 0) bytes.append(value, size);
  }
  return bytes;
}

SqliteTransaction::SqliteTransaction(SqliteDatabase& database, const char* begin) : database_(database) {
  database_.Execute(begin);
}

SqliteTransaction::~SqliteTransaction() {
  if (open_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqliteTransaction::Commit() {
  database_.Execute("COMMIT");
  open_ = false;
}

}  // namespace twinbench
