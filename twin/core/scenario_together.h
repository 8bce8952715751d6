#pragma once

#include "twin/core/scenario.h"
#include "twin/core/scenario_text.h"

namespace twinbench {

/// What the keys of a scenario must be to each other. Only the loader needs this.
/// @throws InputError with the place of the key at fault.
void CheckTogether(const ScenarioText& text, const Scenario& scenario);

}  // namespace twinbench
