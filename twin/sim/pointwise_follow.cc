#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {

Scenario Foreseeable(Scenario scenario) {
  scenario.noise_free = true;
  if (scenario.mechanics.fidelity == "bullet") scenario.mechanics.fidelity = "linear";
  for (TableSettings* table : {&scenario.target, &scenario.reference}) {
    table->harmonics.clear();
    table->errors.reset();
    table->random_rms = {};
  }
  std::erase_if(scenario.effects, [](const EffectSettings& e) { return e.name == "outliers"; });
  return scenario;
}

}  // namespace twinbench::sim
