#include "tests/hidden/own_scenario.h"

#include "tests/support/angle_benches.h"
#include "twin/diagnose/diagnose.h"
#include "twin/benches/registry.h"

namespace twinbench::hidden {
namespace {

/// Half the scenario's readings still tell everything apart and take half the time.
std::vector<std::string> ShortRun(const std::string& bench) {
  if (bench == "rotary_4dof") return {"procedure.positions=24", "procedure.shifts=[0, 1, 5, 8]", "adc.every_sample=false"};
  return {};
}

}  // namespace

Scenario ChangedBench(const std::string& bench, const KeyChange& change, std::uint64_t seed) {
  std::vector<std::string> overrides = ShortRun(bench);
  overrides.insert(overrides.end(), change.with.begin(), change.with.end());
  overrides.push_back(change.key + "=" + change.value);
  if (change.key != "seed") overrides.push_back("seed=" + std::to_string(seed));
  return LoadScenario(test::ScenarioPath(bench + ".toml"), overrides);
}

diagnose::Diagnosis DiagnosedAgainstItself(const Scenario& scenario, const std::string& cache_folder) {
  diagnose::DiagnoseOptions options;
  options.cache_folder = cache_folder;
  return diagnose::Diagnose(test::ReadingsOf(scenario), scenario, options).diagnosis;
}

}  // namespace twinbench::hidden
