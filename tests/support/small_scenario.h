#pragma once

#include "tests/support/rotary_scenario.h"

namespace twinbench::test {

/// A run of the rotary bench without noise, short enough for every test: 12 positions, 2 set-ups.
inline Scenario SmallNoiseFree() {
  Scenario scenario = test::RotaryScenario();
  scenario.noise_free = true;
  RotaryOf(scenario).procedure.positions = 12;
  RotaryOf(scenario).procedure.shifts = {0, 4};
  return scenario;
}

}  // namespace twinbench::test
