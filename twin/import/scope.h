#pragma once

#include <string_view>

#include "twin/import/recording.h"

namespace twinbench::imports {

/// The text export of a TwinCAT scope: rows of `key, value` that describe the channels, then rows in which every
/// group of channels has a time of its own [ms]. The key stands where a group begins, in front of its channels.
/// Values are exported with their scale applied. "Starttime of export" is a Windows file time.
/// @throws InputError if it has no row of names or no rows of numbers.
void ReadScope(std::string_view text, Recording& recording);

}  // namespace twinbench::imports
