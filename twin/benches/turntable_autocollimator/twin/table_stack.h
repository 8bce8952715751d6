#pragma once

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/sim/axes.h"

namespace twinbench::sim {

/// @param actual  Outlives what is returned.
inline TableStack TurntableStack(const Scenario& actual) {
  const TurntableSettings& own = TurntableOf(actual);
  return {own.mechanics, own.turntable, own.multitooth_table};
}

}  // namespace twinbench::sim
