#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {

Scenario Foreseeable(Scenario scenario) {
  scenario.noise_free = true;
  for (TableSettings* table : {&scenario.target, &scenario.reference}) {
    table->harmonics.clear();
    table->errors.reset();
    table->random_rms = {};
  }
  std::erase_if(scenario.effects, [](const EffectSettings& e) { return e.name == "outliers"; });
  return scenario;
}

}  // namespace twinbench::sim
