#pragma once

#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/measured_run.h"

namespace twinbench::tools {

/// Carries a scenario out on what the bench file names and evaluates it.
/// @param page    Shows it.
/// @param answer  Gets what came of it, or of the rehearsal alone; nothing where nobody asks.
/// @throws BenchError if it stopped before its end; what was read is kept.
void Measure(const MeasureOptions& options, LivePage& page, JsonAnswer& answer);

}  // namespace twinbench::tools
