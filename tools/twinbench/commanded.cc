#include "tools/twinbench/commanded.h"

#include <fmt/core.h>

#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_schema.h"

namespace twinbench::tools {

void CommandCompensation(Scenario& scenario, const std::string& option) {
  const std::size_t equals = option.find('=');
  const std::string table = option.substr(0, equals);
  std::string known;
  for (const ScenarioKey& key : KeysOf(scenario)) {
    auto* const* place = std::get_if<std::optional<CompensationTable>*>(&key.field);
    if (!place) continue;
    known += fmt::format("{}{}=FILE.csv", known.empty() ? "" : " or ", key.table);
    if (equals == std::string::npos || key.table != table) continue;
    **place = ReadCompensationTable(option.substr(equals + 1));
    return;
  }
  throw InputError("--compensation " + option, "names no table that can be driven to any angle",
                   known.empty() ? "no --compensation with the bench " + scenario.bench : known);
}

}  // namespace twinbench::tools
