#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

#include "twin/core/errors.h"

namespace twinbench {

/// @return the message of the error that `action` throws, or a text that no test expects.
template <class Error = InputError>
std::string MessageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "(no such error was thrown)";
}

inline std::string Contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
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
