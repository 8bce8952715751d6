#pragma once

#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Fills in the columns that the map does not give: those that are called like the bench's own, then those whose
/// names speak of them ("commanded", "actual", "encoder", ...), then, where there are just two, in their order.
/// What was guessed is put into `remarks`.
/// @param compared  Two quantities at most that are compared: "reference_deg", "measured_deg".
/// @throws InputError that lists the columns, if one cannot be found.
void FillIn(const std::vector<Recording>& recordings, const BenchFormat& bench,
            const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks);

/// Of a list of numbers without a map: the columns of the ready map for tables of angles, which go round once, or of
/// the one for errors. Anything else is left as it is.
void TakeReadyMapOfList(const std::vector<Recording>& recordings, Map& map, std::vector<std::string>& remarks);

/// The bench whose columns the map or the files speak of; the one that compares two columns if none does.
const BenchFormat& BenchFor(const std::vector<Recording>& recordings, const Map& map);

}  // namespace twinbench::imports
