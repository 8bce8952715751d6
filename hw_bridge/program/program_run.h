#pragma once

#include <functional>
#include <map>
#include <string>

#include "hw_bridge/program/program_file.h"

namespace twinbench::hw {

/// Runs the file's command in the folder of the file and waits for its end; what it prints is the user's to see.
/// @param places   What is put in for {scenario}, {stops}, {readings}: absolute paths.
/// @param stop_asked  Looked at all the time: the program and whatever it started are then ended.
/// @throws BenchError if it cannot be started, ends with another code than 0 or by a signal, takes longer than its
///         time, or was stopped; all its processes have ended then.
void RunProgram(const ProgramFile& file, const std::map<std::string, std::string>& places,
                const std::function<bool()>& stop_asked);

}  // namespace twinbench::hw
