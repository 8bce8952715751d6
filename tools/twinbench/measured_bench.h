#pragma once

#include <memory>

#include "hw_bridge/open_bench.h"

namespace twinbench::tools {

/// Opens the bench that a bench file names, whatever kind it is of: hardware, the program's own twin, a recording.
/// @param elapsed  How long ago Time 0 of the run was.
std::unique_ptr<hw::OpenBench> OpenAnyBench(const hw::BenchFile& file, const Scenario& scenario, Duration elapsed);

}  // namespace twinbench::tools
