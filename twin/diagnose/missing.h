#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::diagnose {

/// One sentence for each desired column of readings.csv that no reading (of the phases where it belongs) has, with
/// the causes that cannot be named without it.
///
/// @param bench  Its name.
/// @throws InputError if there is none of that name.
std::vector<std::string> MissingColumns(const std::vector<Reading>& readings, const std::string& bench);

}  // namespace twinbench::diagnose
