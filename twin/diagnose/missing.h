#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::diagnose {

/// One sentence for each optional column of readings.csv that no reading (of the phases where it belongs) has, with
/// the causes that cannot be named without it.
///
/// @param bench  "rotary_4dof", "encoder_comparison", "turntable_autocollimator" or "hob_transmission".
std::vector<std::string> MissingColumns(const std::vector<Reading>& readings, const std::string& bench);

}  // namespace twinbench::diagnose
