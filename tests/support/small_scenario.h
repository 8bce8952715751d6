#pragma once

#include "tests/support/rotary_scenario.h"

namespace twinbench::test {

/// A run of the rotary bench without noise, short enough for every test: 12 positions, 2 set-ups.
inline Scenario SmallNoiseFree() {
  return Altered(RotaryScenario(), {"noise_free=true", "procedure.positions=12", "procedure.shifts=[0, 4]"});
}

}  // namespace twinbench::test
