#pragma once

#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Two files of the same columns and as many rows each, neither of which holds both sides of a comparison: one is the reference's, the
/// other the device's, as the files' names say ("commanded.csv", "measured.csv"), or of a single column each in the order in which
/// they were named. Takes the columns of one axis, and the files side by side; a map that speaks of "1:angle" says so itself.
/// @return false of any other files.
bool TakeSideBySide(Map& map, std::vector<Recording>& recordings);

}  // namespace twinbench::imports
