#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/angle_benches.h"
#include "twin/benches/registry.h"
#include "twin/core/estimator.h"
#include "twin/report/evaluation.h"
#include "twin/uncertainty/budget.h"

/// Runs of any bench, small enough for a test, and their budgets.
namespace twinbench::test {

struct SmallBench {
  std::string file;
  std::vector<std::string> overrides;  // few readings, closed forms
};

/// Every bench, as its scenario has it but for the count of readings.
inline const std::vector<SmallBench>& SmallBenches() {
  static const std::vector<SmallBench> all = {
      {"rotary_4dof.toml",
       {"procedure.positions=12", "procedure.shifts=[0, 1, 5]", "mechanics.fidelity=kinematic",
        "optics.fidelity=closed", "adc.every_sample=false"}},
      {"turntable_autocollimator.toml",
       {"turntable_procedure.positions=12", "turntable_procedure.phases=[\"full_circle\"]",
        "turntable_procedure.passes=[1, -1, 1]"}},
      {"hob_transmission.toml", {"mechanics.fidelity=kinematic", "hob_procedure.samples_per_turn=100"}},
      {"circular_motion.toml", {"circular_procedure.points=60", "circular_procedure.stops=0"}},
      {"freeform_five_axis.toml", {"optics.fidelity=closed", "freeform_procedure.poses=60"}},
      {"encoder_comparison.toml", {"encoder_procedure.stops_per_turn=24"}}};
  return all;
}

inline Scenario Small(const SmallBench& bench, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = bench.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return LoadScenario(ScenarioPath(bench.file), overrides);
}

inline std::vector<uncertainty::Quantity> QuantitiesFrom(const Scenario& scenario, const std::vector<Reading>& readings,
                                                         Estimator estimator = Estimator::kRigorous) {
  return uncertainty::QuantitiesOf(BenchOf(scenario).evaluate(scenario, readings, estimator).results);
}

inline std::vector<uncertainty::Budget> BudgetsOf(const Scenario& scenario) {
  const std::vector<Reading> readings = ReadingsOf(scenario);
  return uncertainty::Budgets(scenario, [&](const Scenario& changed) { return QuantitiesFrom(changed, readings); });
}

}  // namespace twinbench::test
