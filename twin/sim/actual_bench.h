#pragma once

#include "twin/core/scenario.h"
#include "twin/sim/changed_keys.h"
#include "twin/sim/silence.h"

namespace twinbench::sim {

/// The bench as it really is: the scenario's constants with every effect on them, and without any random part if it
/// says noise_free.
/// @param effects  Pointers to effects of one bench.
/// @param silence  Takes the noise out of the bench's own settings.
template <class Effects, class Own>
Scenario ActualBenchOf(const Scenario& nominal, const Effects& effects, void (*silence)(Own&)) {
  Scenario actual = nominal;
  ChangeKeys(actual);
  for (const auto& effect : effects) effect->AlterBench(actual);
  if (actual.noise_free) {
    Silence(actual.environment);
    silence(actual.own.As<Own>());
  }
  return actual;
}

}  // namespace twinbench::sim
