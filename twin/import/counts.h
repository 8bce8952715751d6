#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Takes a column of an encoder's counts for an angle, if it is one: how many make a turn is stated in its name, or
/// above the rows ("counts per turn = 4096", "CPR: 4096", "4096 counts/rev"), or it is the power of two, or the
/// usual counts of a motor behind a gear, at which the column follows a reference that the map has already.
/// @return false if it is none, or nothing says how many.
bool TakeCounts(const std::string& target, const Column& column, const Track& track, Map& map,
                std::vector<std::string>& remarks);

/// The same for a column called counts that was taken before it was known which angle it is compared with.
void TakeCountsBesideAngle(const std::vector<std::string>& compared, const std::vector<Recording>& recordings,
                           Map& map, std::vector<std::string>& remarks);

/// Reference and device in whole numbers from 0 up to more than 1000, neither with a unit, as servos on a bus have them: taken
/// as counts of the power of four above them (1024, 4096, 16384, 65536), of which nothing but the sizes of angles depends. So
/// are counts by name where the reference is sent to a few places only.
void TakeBothForCounts(const std::vector<std::string>& compared, const std::vector<Recording>& recordings, Map& map,
                       std::vector<std::string>& remarks);

/// How many counts make a turn of a column of whole numbers without another unit, as its name, a line with one of the words, or
/// any line above the rows states.
std::optional<double> CountsPerTurnOf(const Column& column, const Track& track, const std::vector<std::string>& words);

/// By its unit or, where it has none, by its name.
bool IsCalledCounts(const Column& column);

/// Refuses what is called counts and was guessed as it stands, as if a count were a degree.
void RequireCountsPerTurn(const std::vector<Recording>& recordings, const Map& map);

}  // namespace twinbench::imports
