#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tools/twinbench/run_folder.h"

namespace twinbench::tools {

/// Says what speaks against readings, before anything is made of them, where whoever reads the answer sees it first.
/// @param where  The file or folder.
/// @return the same in lines.
/// @throws InputError if no result from them can be trusted.
std::vector<std::string> TellDoubts(const std::vector<Reading>& readings, const Scenario& scenario, const std::string& where,
                                    std::FILE* to = stdout);

/// LoadRecordedRun, and TellDoubts: how every command that makes results of readings takes them.
RecordedRun LoadPlausibleRun(const std::string& source, const std::string& scenario_path,
                             const std::vector<std::string>& overrides);

}  // namespace twinbench::tools
