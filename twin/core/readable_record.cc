#include "twin/core/readable_record.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "twin/core/errors.h"

namespace twinbench {
namespace {

namespace fs = std::filesystem;

bool CanBeWritten(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  return access(path.c_str(), W_OK) == 0 && access(folder.c_str(), W_OK) == 0;
}

}  // namespace

ReadableRecord::ReadableRecord(const std::string& path) : place_(path) {
  if (fs::exists(path) && !CanBeWritten(path)) Copy(path);
}

ReadableRecord::~ReadableRecord() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

/// With what was written since the last checkpoint.
void ReadableRecord::Copy(const std::string& path) {
  std::error_code error;
  std::string made = (fs::temp_directory_path(error) / "twinbench-XXXXXX").string();
  if (error || mkdtemp(made.data()) == nullptr)
    throw BenchError(path + ": the folder is read-only, and there is no room to copy the record");
  folder_ = made;
  place_ = made + "/record.sqlite";
  fs::copy_file(path, place_, error);
  if (error) throw BenchError(path + ": cannot be read: " + error.message());
  if (fs::exists(path + "-wal")) fs::copy_file(path + "-wal", place_ + "-wal", error);
  if (error) throw BenchError(path + "-wal: cannot be read: " + error.message());
  fs::permissions(place_, fs::perms::owner_read | fs::perms::owner_write);
  if (fs::exists(place_ + "-wal")) fs::permissions(place_ + "-wal", fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace twinbench
