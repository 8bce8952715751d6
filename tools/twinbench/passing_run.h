#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

namespace twinbench::tools {

/// The readings of a run of the twin that leaves nothing behind.
std::vector<Reading> ReadingsOfTwin(const Scenario& scenario);

}  // namespace twinbench::tools
