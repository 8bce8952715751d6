#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/campaign/trial.h"

namespace twinbench::campaign {

/// Every number of results.json that has its standard uncertainty beside it, in any of the ways in which benches
/// write that: {"value": 1, "u": 0.1}, {"value_um": 1, "u_um": 0.1}, {"ez_arcsec": 1, "u_ez_arcsec": 0.1}, and
/// lists of equal length instead of the numbers.
///
/// Its name is its path: "setups[0].offset_x_um", "target.ez_arcsec[3]"; `value` is left out of it. A null is NaN.
/// What has no uncertainty, not even null, is not kept.
std::vector<TrialResult> StatedResults(const nlohmann::json& results);

}  // namespace twinbench::campaign
