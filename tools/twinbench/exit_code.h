#pragma once

#include <exception>
#include <string>

namespace twinbench::tools {

enum ExitCode { kDone = 0, kWorldFailed = 1, kBadInput = 2, kStateUnknown = 3 };

/// What the program ends with when this ended its command.
ExitCode ExitCodeOf(const std::exception& error);

/// What it says then, on stderr and wherever else somebody looks.
std::string FailureText(const std::exception& error);

}  // namespace twinbench::tools
