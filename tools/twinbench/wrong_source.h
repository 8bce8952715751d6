#pragma once

#include <string>

#include "twin/core/errors.h"

namespace twinbench::tools {

/// The refusal of what was named as a run and is none: what it is instead (a scenario, a recording, a folder of runs), and what to
/// type. A run has its record or its scenario in a folder of its own.
InputError NoRun(const std::string& source);

/// @throws InputError unless there is such a folder.
void RequireRunFolder(const std::string& source);

}  // namespace twinbench::tools
