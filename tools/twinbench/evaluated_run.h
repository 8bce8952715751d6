#pragma once

#include <string>

#include "twin/core/scenario.h"

namespace twinbench::tools {

/// Evaluates a finished run from its record, as any later look at it will, writes results.json
/// and prints the summary.
/// @return whether there was enough to separate the tables.
bool EvaluateRun(const Scenario& scenario, const std::string& folder);

}  // namespace twinbench::tools
