#pragma once

#include <string>
#include <vector>

#include "twin/import/recording.h"

namespace twinbench::imports {

/// Columns of readings, angles or errors that are in "sec" or "minutes" are in those of arc: nothing that is called so is a
/// time. Each is named in a remark, once in a file.
void TakeSecondsOfArc(Track& track, std::vector<std::string>& remarks);

}  // namespace twinbench::imports
