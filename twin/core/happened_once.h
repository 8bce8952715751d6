#pragma once

#include "twin/core/scenario.h"

namespace twinbench {

/// The parameter that says when [reading].
inline constexpr const char* kHappenedAt = "at_reading";

/// Whether it happens at one reading of one run: a slip, a hop of a mode, a step.
bool HappensOnce(const EffectSettings& effect);

/// Such an effect as a later run of the same bench shows it: what has happened stays, from the first reading on.
EffectSettings AsHappened(EffectSettings effect);

/// The scenario's bench in another of its runs (Scenario::repeat): what happens once happens in the run that the
/// scenario is of, has happened in those after it, and not yet in those before.
Scenario InRun(Scenario scenario, int repeat);

}  // namespace twinbench
