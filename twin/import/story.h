#pragma once

#include <string>
#include <vector>

#include "twin/import/import.h"
#include "twin/import/join.h"
#include "twin/import/make_readings.h"

namespace twinbench::imports {

/// What was understood, derived and left out: lines for a person.
/// @param guessed  What was taken for granted about the columns.
std::string StoryOf(const std::vector<Recording>& recordings, const Joined& joined, const Tally& tally,
                    const std::vector<std::string>& guessed, const Map& map, const Imported& imported);

}  // namespace twinbench::imports
