#pragma once

#include <string>

namespace twinbench {

/// Where a record can be read. SQLite shares a record with its writer by files beside it; on a medium or in a folder
/// that cannot be written there is no room for them, so a copy is read there, which goes with this object.
class ReadableRecord {
 public:
  /// @param path  Of record.sqlite. @throws BenchError if it cannot be copied.
  explicit ReadableRecord(const std::string& path);
  ~ReadableRecord();
  ReadableRecord(const ReadableRecord&) = delete;
  ReadableRecord& operator=(const ReadableRecord&) = delete;

  const std::string& place() const { return place_; }

 private:
  void Copy(const std::string& path);

  std::string place_;
  std::string folder_;  // of the copy; empty: there is none
};

}  // namespace twinbench
