#pragma once

#include <string>

#include "twin/core/scenario.h"

namespace twinbench::tools {

/// The compensation of a file takes the place of what the scenario gives that table.
/// @param option  "target=table.csv": a table of the bench that can be driven to any angle.
/// @throws InputError if there is no such table, or the file cannot be read.
void CommandCompensation(Scenario& scenario, const std::string& option);

}  // namespace twinbench::tools
