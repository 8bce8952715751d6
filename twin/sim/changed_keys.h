#pragma once

#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::sim {

/// Changes the keys that the scenario's effects change by their catalogue (EffectParameter::changes), block by block.
/// @throws std::logic_error if the catalogue names a key that the bench has not, or one that is no number.
void ChangeKeys(Scenario& actual);

/// The effects for which that is not all.
std::vector<EffectSettings> BeyondKeys(const Scenario& scenario);

}  // namespace twinbench::sim
