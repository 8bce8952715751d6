#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "twin/core/errors.h"

namespace twinbench::fuzz {

/// A file in memory, for readers that want a path. It goes with this object.
class FileOfBytes {
 public:
  explicit FileOfBytes(std::string_view bytes) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
    for (std::size_t written = 0; written < bytes.size();) {
      const ssize_t n = write(descriptor_, bytes.data() + written, bytes.size() - written);
      if (n <= 0) throw BenchError("no room for a file in memory");
      written += static_cast<std::size_t>(n);
    }
  }
  ~FileOfBytes() { close(descriptor_); }
  FileOfBytes(const FileOfBytes&) = delete;
  FileOfBytes& operator=(const FileOfBytes&) = delete;

  std::string Path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

inline std::string Contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// An InputError is a right answer.
template <class Read>
void RefusingIsRight(Read read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

}  // namespace twinbench::fuzz
