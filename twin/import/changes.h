#pragma once

#include <string_view>

#include "twin/import/recording.h"

namespace twinbench::imports {

/// One line a change: name, date, time of day, value, as `camonitor` writes; each name is a track of its own that
/// holds its value until it changes. Lines that tell of connections, of arrays or of texts are counted and left
/// out.
/// @throws InputError if no line is such a change.
void ReadChanges(std::string_view text, Recording& recording);

}  // namespace twinbench::imports
