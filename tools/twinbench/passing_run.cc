#include "tools/twinbench/passing_run.h"

#include <nlohmann/json.hpp>

#include "twin/benches/registry.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {

std::vector<Reading> ReadingsOfTwin(const Scenario& scenario) {
  const auto record = RunRecord::CreateInMemory({TWINBENCH_VERSION, "twin", scenario.seed, "", scenario.bench});
  BenchOf(scenario).make_twin(scenario)->CarryOut(*record, {});
  return record->Readings();
}

}  // namespace twinbench::tools
