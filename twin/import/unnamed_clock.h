#pragma once

#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Of a file without names whose first column rises strictly in equal steps while two others follow each other, or of two files that
/// have it in common: that column is a clock, in ms where the steps are whole, in s where they are not; in steps of one it counts the
/// rows. What was taken for granted is put into the recording's remarks. A map that speaks of the column, or of a clock, goes before.
void TakeUnnamedClock(const Map& map, std::vector<Recording>& recordings);

}  // namespace twinbench::imports
