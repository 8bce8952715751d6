#pragma once

#include <CLI/CLI.hpp>

namespace twinbench::tools {

/// The help of the command that a command line names opens with what it answers and with two examples.
/// @param command  argv[1], or nothing where there is none; another word changes nothing.
void OpenWithExamples(CLI::App& app, const char* command);

}  // namespace twinbench::tools
