#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/core/scenario_schema.h"

/// bench.toml of kind "program": a laboratory that acquires with software of its own.
namespace twinbench::hw {

struct ProgramFile {
  std::string path;  // for messages; the command runs in its folder
  std::string kind = "program";
  std::string name;                  // of the bench, for the record
  std::vector<std::string> command;  // program and arguments; {scenario}, {stops}, {readings} are put in
  double timeout_s = 3600.0;         // of a run
};

/// Every key of the file format.
std::vector<ScenarioKey> KeysOf(ProgramFile& file);

/// Whether the bench file is of that kind; nothing else in it is looked at.
/// @throws InputError if it cannot be read or is no TOML.
bool IsProgramFile(const std::string& path);

/// @throws InputError with file:line for a syntax error, an unknown key, no command, a command that never says
///         where {readings} go.
ProgramFile LoadProgramFile(const std::string& path);

}  // namespace twinbench::hw
