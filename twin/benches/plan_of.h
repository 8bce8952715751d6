#pragma once

#include <vector>

#include "twin/core/scenario.h"
#include "twin/plausible/plan.h"

namespace twinbench {

/// The title of a scenario that an import made up: it says what was recorded, and plans nothing.
inline constexpr const char* kImportedTitle = "imported from ";

/// How many readings the scenario's procedure takes, and how they follow each other: by dwells, speeds and feeds.
/// Nothing of a scenario that was made up for a recording.
plausible::Plan PlanOf(const Scenario& scenario, const std::vector<Reading>& readings);

}  // namespace twinbench
