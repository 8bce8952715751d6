#include "tools/twinbench/next_scenarios.h"

#include <fmt/core.h>

#include <filesystem>

#include "tools/twinbench/overwriting.h"
#include "tools/twinbench/run_folder.h"
#include "twin/core/happened_once.h"

namespace twinbench::tools {
namespace {

std::string FileOfNext(const std::string& output, std::size_t at, std::size_t count, const plan::NextRun& run) {
  if (count == 1) return output;
  const std::filesystem::path path(output);
  const std::size_t digits = std::to_string(count).size();
  const std::string name = fmt::format("{}-{:0{}}-of-{}-{}{}", path.stem().string(), at + 1, digits, count,
                                       run.name, path.extension().string());
  return (path.parent_path() / name).string();
}

}  // namespace

std::vector<Scenario> ScenariosOf(const std::vector<plan::NextRun>& runs, const Scenario& scenario) {
  std::vector<Scenario> next;
  for (const plan::NextRun& run : runs)
    next.push_back(InRun(Altered(scenario, run.sets), scenario.repeat + 1 + static_cast<int>(next.size())));
  return next;
}

void RequireFreeNext(const std::string& output, const std::vector<plan::NextRun>& runs, const std::string& scenario_file, bool force) {
  if (output.empty()) return;
  for (std::size_t k = 0; k < runs.size(); ++k) RequireFree(FileOfNext(output, k, runs.size(), runs[k]), {scenario_file}, force);
}

void WriteNext(const std::string& output, const std::vector<plan::NextRun>& runs, const Scenario& scenario) {
  const std::vector<Scenario> next = ScenariosOf(runs, scenario);
  for (std::size_t k = 0; k < runs.size(); ++k)
    WriteFileAtOnce(FileOfNext(output, k, runs.size(), runs[k]), WriteScenario(next[k]));
}

}  // namespace twinbench::tools
