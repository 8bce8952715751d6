#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Of a map of circles: which columns are the commanded and the actual places of two axes by where they go, whatever they are called. A pair
/// that stays together is an axis; what lies closer to one circle was commanded, if no name says so. Of a map that seeks no commanded
/// places: the two lengths that alone go round a circle.
/// @return The columns by the names of what is sought; empty: there is no such circle.
std::map<std::string, std::string> ColumnsOnCircle(const Map& map, Track& track, std::vector<std::string>& remarks);

}  // namespace twinbench::imports
