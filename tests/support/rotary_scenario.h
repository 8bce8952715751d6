#pragma once

#include "twin/benches/names.h"
#include "twin/core/scenario.h"

namespace twinbench::test {

/// The reference rotary bench: every key at its default.
inline Scenario RotaryScenario() {
  Scenario scenario;
  scenario.bench = kRotaryBench;
  return scenario;
}

}  // namespace twinbench::test
