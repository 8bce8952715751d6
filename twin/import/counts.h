#pragma once

#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Takes a column of an encoder's counts for an angle, if it is one: how many make a turn is stated above the rows
/// ("counts per turn = 4096", "CPR: 4096"), or it is the power of two at which the column follows a reference that the
/// map has already.
/// @return false if it is none, or nothing says how many.
bool TakeCounts(const std::string& target, const Column& column, const Track& track, Map& map,
                std::vector<std::string>& remarks);

}  // namespace twinbench::imports
