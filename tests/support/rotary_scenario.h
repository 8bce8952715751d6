#pragma once

#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/scenario.h"

namespace twinbench::test {

/// The reference rotary bench: every key at its default, but tables that stand where they are sent at once. Tests
/// of bodies ask for bodies.
inline Scenario RotaryScenario() {
  Scenario scenario;
  scenario.bench = kRotaryBench;
  RotaryOf(scenario).mechanics.fidelity = "kinematic";
  return scenario;
}

}  // namespace twinbench::test
