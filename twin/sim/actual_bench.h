#pragma once

#include "twin/core/scenario.h"
#include "twin/sim/silence.h"

namespace twinbench::sim {

/// The bench as it really is: the scenario's constants with every effect on them, and without any random part if it
/// says noise_free.
/// @param effects  Pointers to effects of one bench.
template <class Effects>
Scenario ActualBenchOf(const Scenario& nominal, const Effects& effects) {
  Scenario actual = nominal;
  for (const auto& effect : effects) effect->AlterBench(actual);
  if (actual.noise_free) Silence(actual);
  return actual;
}

}  // namespace twinbench::sim
