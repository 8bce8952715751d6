#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace twinbench::imports {

/// True of lines that are nearly all "target=5.0 actual=5.03" or "ref: 5.0, enc: 5.03", as serial monitors show them.
bool ArePairs(const std::vector<std::string_view>& lines);

/// The same as a table between tabs, the names above it; lines that are no such pairs stay as they are.
std::string TableOfPairs(std::string_view text);

}  // namespace twinbench::imports
