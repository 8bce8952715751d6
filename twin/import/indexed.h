#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace twinbench::imports {

/// True of lines that are nearly all "TGT_DATA[2]=-15", "REF_DATA_FWD[2,1]=-15.0037": a positioning test, a value a line.
bool AreIndexed(const std::vector<std::string_view>& lines);

/// The same as a table between tabs, a row a target, a column a run that its array's name calls up or down; "UNIT=mm" is the unit.
/// Empty if there is no list of targets, or no array beside it.
std::string TableOfIndexed(std::string_view text);

}  // namespace twinbench::imports
