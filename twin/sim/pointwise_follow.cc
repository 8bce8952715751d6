#include "twin/sim/pointwise_follow.h"

#include "twin/sim/own_tables.h"

namespace twinbench::sim {

Scenario Foreseeable(Scenario scenario, const std::vector<Reading>& record) {
  scenario.noise_free = true;
  std::erase_if(scenario.effects, [](const EffectSettings& e) { return e.name == "outliers"; });
  LeaveOutForeignTables(record, scenario.empiricals);
  return scenario;
}

void LeaveFree(TableSettings& table) {
  table.harmonics.clear();
  table.errors.reset();
  table.random_rms = {};
}

void WithoutBullet(MechanicsSettings& mechanics) {
  if (mechanics.fidelity == "bullet") mechanics.fidelity = "linear";
}

}  // namespace twinbench::sim
