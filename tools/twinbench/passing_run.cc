#include "tools/twinbench/passing_run.h"

#include <nlohmann/json.hpp>

#include "twin/benches/registry.h"
#include "twin/core/kept_readings.h"

namespace twinbench::tools {

std::vector<Reading> ReadingsOfTwin(const Scenario& scenario) {
  KeptReadings kept;
  BenchOf(scenario).make_twin(scenario)->CarryOut(kept, {});
  return kept.Take();
}

}  // namespace twinbench::tools
