#pragma once

#include <vector>

namespace twinbench::imports {

/// By how many rows a device is behind a command that runs along smooth profiles, by what its error has in proportion to the step
/// from row to row beside what it has in proportion to the place and in the sense of the motion: at rest nothing goes by that.
/// @return 0 where the command is no profile or less than half of the rest of the error is so.
double RowsBehindBySpeed(const std::vector<double>& command, const std::vector<double>& shown);

}  // namespace twinbench::imports
