#pragma once

#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Takes one axis of a file that has several and says which others there are: rows of one axis where a column says whose they are,
/// or one pair of a command and a place where each axis has columns of its own. Which one `map.course.axis_number` says, the first if
/// it is 0. What the map gives already stays, and nothing is chosen where there is one axis.
/// @throws InputError if there are not so many, or none but one where another is asked for.
void TakeAxis(Map& map, std::vector<Recording>& recordings);

/// The one of several that the map says, the first where it says none, which is said.
/// @param axes  In words, by number.
/// @throws InputError if there are not so many.
std::size_t ChosenOf(const std::vector<std::string>& axes, const Map& map, Recording& recording);

}  // namespace twinbench::imports
