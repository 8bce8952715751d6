#include "twin/benches/plan_of.h"

#include "twin/benches/registry.h"

namespace twinbench {

plausible::Plan PlanOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  const auto plan = BenchOf(scenario).plan;
  return plan && !scenario.title.starts_with(kImportedTitle) ? plan(scenario, readings) : plausible::Plan{};
}

}  // namespace twinbench
