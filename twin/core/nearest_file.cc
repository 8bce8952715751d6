#include "twin/core/nearest_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "twin/core/nearest_key.h"

namespace twinbench {
namespace {

namespace fs = std::filesystem;

/// A build stands in the repository, an installed program beside its share.
std::vector<fs::path> ShippedScenarios() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  return {"scenarios", program / "../../scenarios", program / "../share/twinbench/scenarios"};
}

/// How far a name is from what was asked for; at kFar it was not meant. A name without ending asks for any.
constexpr int kFar = 1000;
int Distance(const fs::path& asked, const fs::path& name) {
  if (asked.has_extension() && asked.extension() != name.extension()) return kFar;
  const std::string a = asked.stem().string(), b = name.stem().string();
  const int distance = EditDistance(a, b), slip = std::max(1, static_cast<int>(a.size()) / 3);
  return distance <= slip || (a.size() >= 3 && b.starts_with(a)) ? distance : kFar;
}

using Found = std::pair<int, fs::path>;  // distance first; of two alike the first by name, for a disk has no order

template <typename Iterator>
Found NearestIn(const fs::path& folder, const fs::path& asked) {
  Found nearest{kFar, ""};
  std::error_code error;
  for (Iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    nearest = std::min(nearest, Found{Distance(asked, entry->path().filename()), entry->path()});
  return nearest;
}

std::string WhyNot(const std::string& path, const std::string& what) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return what + "does not exist";
  if (fs::is_directory(status)) return what + "is a folder";
  errno = 0;
  if (std::ifstream(path).is_open()) return what + "is empty";
  return fmt::format("{}cannot be read: {}", what, std::generic_category().message(errno));
}

std::string NearestFile(const std::string& path) {
  const fs::path plain(path.substr(0, path.find_last_not_of('/') + 1));
  Found nearest = NearestIn<fs::directory_iterator>(plain.has_parent_path() ? plain.parent_path() : ".", plain.filename());
  for (const fs::path& folder : ShippedScenarios()) {
    if (const Found found = NearestIn<fs::recursive_directory_iterator>(folder, plain.filename()); found.first < nearest.first) nearest = found;
  }
  return nearest.second.lexically_normal().string();
}

}  // namespace

std::string OrNearestFile(const std::string& expected, const std::string& path) {
  std::error_code unknown;
  const std::string nearest = fs::exists(path, unknown) ? "" : NearestFile(path);
  return nearest.empty() ? expected : expected + "; the nearest is " + nearest;
}

InputError NothingToRead(const std::string& path, const std::string& expected, const std::string& named) {
  return {named.empty() ? path : named, WhyNot(path, named.empty() ? "" : path + " "), OrNearestFile(expected, path)};
}

}  // namespace twinbench
