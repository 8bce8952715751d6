#pragma once

#include <string_view>
#include <vector>

#include "twin/import/layout.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// True of lines among which are names of columns: a target, and runs that all say up or down.
bool AreCycles(const std::vector<std::string_view>& lines);

/// Tables of a positioning test after ISO 230-2: a row a target, a column a run. Approaches from below and from
/// above stand in a table each (the text above says which) or in columns whose names say it: "1 up", "run 2 -", "3
/// ↓". Entries are positions or deviations from the target, whichever they are closer to.
///
/// The track has the readings in the order in which such a test is driven: for every run all targets upwards, then
/// downwards. Columns: target, actual, direction, run.
/// @throws InputError if there is no such table, or nothing says the direction of the runs.
void ReadCycles(std::string_view text, const Layout& layout, Recording& recording);

}  // namespace twinbench::imports
