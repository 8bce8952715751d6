#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "twin/core/errors.h"

namespace twinbench {

/// @return the message of the InputError that `action` throws, or a text that no test expects.
inline std::string MessageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no InputError was thrown)";
}

/// Where nobody waits for a disk, if there is such a place and TMPDIR names no other: a record is flushed behind
/// every reading. What that is worth when the power goes, tests/power_cut asks.
inline std::filesystem::path PlaceForFiles() {
  constexpr const char* kMemory = "/dev/shm";
  constexpr std::uintmax_t kEnough = 1'000'000'000;
  std::error_code none;
  const bool is_roomy =
      !std::getenv("TMPDIR") && std::filesystem::space(kMemory, none).available > kEnough && !none;
  return is_roomy ? kMemory : std::filesystem::temp_directory_path();
}

/// A folder of this process that goes at the end of its life.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (PlaceForFiles() / "twinbench_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw BenchError("no temporary folder can be made");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path() const { return path_.string(); }
  std::string File(const std::string& name) const { return (path_ / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(File(name), std::ios::binary) << text;
    return File(name);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace twinbench
