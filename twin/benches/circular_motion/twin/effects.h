#pragma once

#include <vector>

#include "twin/benches/circular_motion/twin/machine.h"

/// What the effects of a scenario change about the bench circular_motion.
namespace twinbench::sim {

/// The constants of the bench with all effects that are constants of it.
CircularSettings WithEffects(Scenario scenario);

/// Effects that the machine has beside its settings.
void AddToMachine(const std::vector<EffectSettings>& effects, CircleMachine& machine);

}  // namespace twinbench::sim
