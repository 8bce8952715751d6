#pragma once

#include <string>
#include <string_view>

#include "twin/import/recording.h"

namespace twinbench::imports {

/// A table in the text of a program, `const float lookup[16384] = { 63.92, 63.94, ... };`. Comments are skipped;
/// `float zero = 1.2;` beside it becomes a named number.
/// @param name  Of the array; empty: the longest.
/// @throws InputError if there is no such array with numbers.
void ReadArray(std::string_view text, const std::string& name, Recording& recording);

}  // namespace twinbench::imports
