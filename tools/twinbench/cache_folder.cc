#include "tools/twinbench/cache_folder.h"

#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

std::string DefaultCache() {
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder)
    return std::string(folder) + "/twinbench";
  if (const char* home = std::getenv("HOME"); home && *home) return std::string(home) + "/.cache/twinbench";
  return "";
}

}  // namespace

void AddCache(CLI::App& command, std::string& folder) {
  command.add_option("--cache", folder, "folder that keeps calibrated thresholds; else the user's cache");
}

std::string CacheFolder(const std::string& asked) {
  const std::string folder = asked.empty() ? DefaultCache() : asked;
  if (folder.empty()) return "";
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder)) return folder;
  fmt::print(stderr, "calibrations are not kept: {} cannot be made\n", folder);
  return "";
}

}  // namespace twinbench::tools
