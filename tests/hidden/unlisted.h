#pragma once

#include <string>
#include <vector>

#include "tests/hidden/twin_cases.h"

namespace twinbench::hidden {

/// Causes that the catalogue lacks, written into the readings of a run that is otherwise clean: `magnitudes` x
/// `seeds` cases of each.
std::vector<Plan> UnlistedPlans(const std::string& bench, const TwinOptions& options);

}  // namespace twinbench::hidden
