#include "tools/twinbench/wrong_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "tools/twinbench/run_folder.h"
#include "twin/core/nearest_file.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

bool IsRun(const std::string& folder) {
  std::error_code unknown;
  return fs::exists(RunFolder{folder}.record(), unknown) || fs::exists(RunFolder{folder}.scenario(), unknown);
}

std::vector<std::string> RunsIn(const std::string& folder) {
  std::vector<std::string> runs;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (IsRun(entry->path().string())) runs.push_back(entry->path().lexically_normal().string());
  std::ranges::sort(runs);
  return runs;
}

InputError NoRunButFolder(const std::string& folder) {
  constexpr std::size_t kMostNamed = 6;
  std::vector<std::string> runs = RunsIn(folder);
  if (runs.empty()) return {folder, "a folder without a run: it has no record.sqlite and no scenario.toml", "the folder of a run"};
  const std::size_t count = runs.size();
  const std::string more = count > kMostNamed ? fmt::format(" and {} more", count - kMostNamed) : "";
  runs.resize(std::min(kMostNamed, count));
  return {folder, fmt::format("a folder of {} run{}, none itself", count, count == 1 ? "" : "s"), fmt::format("one of them: {}{}", fmt::join(runs, ", "), more)};
}

}  // namespace

InputError NoRun(const std::string& source) {
  std::error_code unknown;
  if (!fs::exists(source, unknown)) return NothingToRead(source, "the folder of a run");
  if (fs::is_directory(source, unknown)) return NoRunButFolder(source);
  const std::string run = "runs/" + fs::path(source).stem().string();
  if (source.ends_with(".toml"))
    return {source, "a scenario or another TOML file, no run", fmt::format("the folder of its run, which `twinbench run {} -o {}` makes", source, run)};
  return {source, "a file, no run", fmt::format("the folder of its run, which `twinbench import {} -o {}` makes of a recording", source, run)};
}

void RequireRunFolder(const std::string& source) {
  if (!IsRun(source)) throw NoRun(source);
}

}  // namespace twinbench::tools
