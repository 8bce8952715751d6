#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "twin/core/errors.h"
#include "twin/core/whole_file.h"

/// What the program reads of others, one function each, to be fed with whatever there may be.
namespace twinbench::fuzz {

struct Target {
  const char* name;
  /// Reads `bytes` as a file or as all that a client says. An InputError, a BenchError or, where a header says so, another
  /// std::runtime_error is a right answer and stays within; whatever else leaves it is a fault of ours.
  void (*read)(std::string_view bytes);
  /// Where it begins: files and folders from the root of the sources, separated by blanks; beside them tests/data/fuzz/<name>.
  const char* seeds;
  /// More of them, where it is this program that writes such files; null: none.
  std::vector<std::string> (*made_seeds)() = nullptr;
};

std::span<const Target> TextTargets();
std::span<const Target> FileTargets();
std::span<const Target> ConversationTargets();

/// All there are.
inline std::vector<Target> Targets() {
  std::vector<Target> all;
  for (const auto family : {TextTargets(), FileTargets(), ConversationTargets()}) all.insert(all.end(), family.begin(), family.end());
  return all;
}

/// Input number `number` that is made of the seeds: the same for the same arguments on every machine. One to eight changes of a seed:
/// bits, bytes, pieces left out, doubled, moved or taken from another seed, numbers and separators that readers stumble over.
/// @param seeds  Not empty.
std::string Mutated(const std::vector<std::string>& seeds, std::uint64_t number);

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

/// An InputError is a right answer.
template <class Read>
void RefusingIsRight(Read read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

}  // namespace twinbench::fuzz
