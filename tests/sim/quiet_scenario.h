#pragma once

#include "tests/support/rotary_scenario.h"

namespace twinbench::sim {

inline Scenario Quiet() {
  Scenario scenario = test::RotaryScenario();
  scenario.noise_free = true;
  return scenario;
}

/// With noise, but none of the amplifier.
inline Scenario OnlyTheLightsNoise() {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).amplifier.noise_V = 0.0;
  return scenario;
}

}  // namespace twinbench::sim
