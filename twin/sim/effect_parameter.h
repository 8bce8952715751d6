#pragma once

#include "twin/core/scenario.h"

namespace twinbench::sim {

/// Value of a parameter of the catalogue. @throws std::logic_error if the loader did not fill it.
double Parameter(const EffectSettings& effect, const char* name);

}  // namespace twinbench::sim
