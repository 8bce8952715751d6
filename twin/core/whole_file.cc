#include "twin/core/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "twin/core/errors.h"

namespace twinbench {
namespace {

namespace fs = std::filesystem;

bool WriteAll(int handle, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = write(handle, text.data() + at, text.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += static_cast<std::size_t>(written);
  }
  return true;
}

/// @param until_on_disk  A name may be on the disk before what it names: after a power failure the file would be empty.
bool Wrote(const std::string& file, const std::string& text, bool until_on_disk) {
  const int handle = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (handle < 0) return false;
  const bool wrote = WriteAll(handle, text) && (!until_on_disk || fsync(handle) == 0);
  return close(handle) == 0 && wrote;
}

}  // namespace

void WriteFileAtOnce(const std::string& path, const std::string& text) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(path, error);
  const bool has_place = !error && (!fs::exists(path) || fs::is_regular_file(target));  // an open file of /proc has none either
  if (!has_place) {
    if (!Wrote(path, text, false)) throw BenchError(path + ": cannot be written");
    return;
  }
  const std::string beside = target.string() + ".part";
  const bool is_whole = Wrote(beside, text, true);
  error.clear();
  if (is_whole) fs::rename(beside, target, error);
  if (is_whole && !error) return;
  std::error_code ignored;
  fs::remove(beside, ignored);
  throw BenchError(path + ": " + (is_whole ? error.message() : "cannot be written"));
}

std::string BytesOfFile(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

}  // namespace twinbench
