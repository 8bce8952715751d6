#pragma once

#include <string>
#include <utility>

namespace twinbench {

/// Says that this program writes a file, by a lock on another one beside it. The system takes it away when the program ends,
/// however it ends.
class WriterLock {
 public:
  /// @param path  Of the lock; made if it is not there, and left.
  /// @param what  Is written: for the message.
  /// @throws InputError if another program holds it; BenchError if the file cannot be made.
  WriterLock(const std::string& path, const std::string& what);
  ~WriterLock();
  WriterLock(WriterLock&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  WriterLock& operator=(WriterLock&&) = delete;

  /// Whether somebody holds the lock of this path.
  static bool IsHeld(const std::string& path);

 private:
  int handle_ = -1;
};

}  // namespace twinbench
