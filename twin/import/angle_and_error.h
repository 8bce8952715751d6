#pragma once

#include <string>
#include <vector>

#include "twin/import/choices.h"

namespace twinbench::imports {

/// "angle, error": what the device shows is the sum; with a correction, the difference.
/// @param columns  That may be an angle or an error.
/// @param compared  Reference and device of the bench.
/// @return false where there is no such pair, or something else may be where the device stands.
bool TakeAngleAndError(const std::vector<Choice>& columns, const std::vector<std::string>& compared, Map& map,
                       std::vector<std::string>& remarks);

}  // namespace twinbench::imports
