#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tools/twinbench/run_folder.h"

/// What is there already stays, unless --force says otherwise. Results in JSON, which the same command makes again, are replaced; inputs and
/// records are never.
namespace twinbench::tools {

/// The option --force.
void AddForce(CLI::App& command, bool& force);

/// Before a file is written that somebody may have worked on, signed or measured.
/// @param output  Empty or "-": no file. A file of no length is none either: a place that somebody took.
/// @param inputs  As of RequireOutput.
/// @param own     What a file of the same command begins with, within its first lines, where one may take another's place; empty: none may.
/// @throws InputError as RequireOutput; and if it is there, is none of the command's own and `force` was not said.
void RequireFree(const std::string& output, const std::vector<std::string>& inputs, bool force, std::string_view own = "");

/// Before a run of the twin is made: with --force an earlier run of the twin in the folder gives way, and nothing else does.
/// @param scenario  The file that is carried out.
/// @throws InputError if there is a record and `force` was not said, or it is of a measurement or an import, or some program is writing it,
///         or the folder's scenario.toml is the one that is carried out.
void MakeWayForRun(const RunFolder& folder, const std::string& scenario, bool force);

}  // namespace twinbench::tools
