#pragma once

#include "tests/support/rotary_scenario.h"

namespace twinbench::sim {

inline Scenario Quiet() {
  Scenario scenario = test::RotaryScenario();
  scenario.noise_free = true;
  return scenario;
}

}  // namespace twinbench::sim
