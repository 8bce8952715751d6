#include "twin/core/happened_once.h"

#include <algorithm>
#include <utility>

namespace twinbench {

bool HappensOnce(const EffectSettings& effect) {
  return effect.parameters.contains(kHappenedAt);
}

EffectSettings AsHappened(EffectSettings effect) {
  effect.parameters[kHappenedAt] = 0.0;
  return effect;
}

Scenario InRun(Scenario scenario, int repeat) {
  const int own = std::exchange(scenario.repeat, repeat);
  if (repeat < own) std::erase_if(scenario.effects, HappensOnce);
  if (repeat <= own) return scenario;
  for (EffectSettings& effect : scenario.effects) {
    if (HappensOnce(effect)) effect = AsHappened(std::move(effect));
  }
  return scenario;
}

}  // namespace twinbench
