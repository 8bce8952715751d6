#pragma once

#include "twin/campaign/variation.h"
#include "twin/core/scenario_text.h"

namespace twinbench::campaign {

/// Reads one [[vary]] block.
/// @throws InputError with file:line if it has no key, none or several of values, from and distribution, a key that
///         is unknown or belongs to another of them, or a parameter that is missing or impossible.
Variation ReadVariation(const TomlValue& block);

}  // namespace twinbench::campaign
