#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "twin/import/recording.h"

namespace twinbench::imports {

/// True of `name = [1.0, 2.0 ...`, as Python and MATLAB have it.
bool OpensList(std::string_view line);

/// True of numbers and nothing else: all in one line, or one a line.
bool IsBareList(const std::vector<std::string_view>& lines);

/// A table in the text of a program, `const float lookup[16384] = { 63.92, 63.94, ... };`. Comments are skipped;
/// `float zero = 1.2;` beside it becomes a named number.
/// @param name  Of the array; empty: the longest, or those of one length where the names say which is the reference's.
/// @throws InputError if there is no such array with numbers.
void ReadArray(std::string_view text, const std::string& name, Recording& recording);

}  // namespace twinbench::imports
