#pragma once

#include <string>
#include <vector>

#include "twin/import/companions.h"
#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Takes one axis of a file that has several and says which others there are: rows of one axis where a column says whose they are,
/// or one pair of a command and a place where each axis has columns of its own. Which one `map.course.axis_number` says, the first if
/// it is 0. What the map gives already stays, and nothing is chosen where there is one axis.
void TakeAxis(Map& map, std::vector<Recording>& recordings);

/// Two columns that may be one axis by their names: those say nothing, or the same but for a side.
bool MayBeOneAxis(const AxisPair& pair);

/// The one of several that the map says, the first where it says none, which is said. The map asks for no other one then.
/// @param axes  In words, by number.
/// @throws InputError if there are not so many.
std::size_t ChosenOf(const std::vector<std::string>& axes, Map& map, std::vector<std::string>& remarks);

/// Takes the two columns of one of these axes, the one that the map says.
void TakeOneOf(const std::vector<AxisPair>& pairs, const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks);

/// @throws InputError if the map asks for an axis and none was chosen of several.
void RequireAxisWasThere(const Map& map);

}  // namespace twinbench::imports
