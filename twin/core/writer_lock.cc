#include "twin/core/writer_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "twin/core/errors.h"

namespace twinbench {

WriterLock::WriterLock(const std::string& path, const std::string& what) {
  handle_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (handle_ < 0) throw BenchError(path + ": cannot be made");
  if (flock(handle_, LOCK_EX | LOCK_NB) == 0) return;
  close(handle_);
  throw InputError(what, "another program is writing it", "one program at a time: wait for its end, or take another name");
}

WriterLock::~WriterLock() {
  if (handle_ >= 0) close(handle_);
}

bool WriterLock::IsHeld(const std::string& path) {
  const int handle = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return false;
  const bool is_free = flock(handle, LOCK_SH | LOCK_NB) == 0;
  close(handle);
  return !is_free;
}

}  // namespace twinbench
