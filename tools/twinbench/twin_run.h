#pragma once

#include "tools/twinbench/live_page.h"
#include "tools/twinbench/run_folder.h"

namespace twinbench::tools {

/// Carries out a scenario of any bench on its twin: makes the folder with resolved scenario, truth and record.
/// @param images  Write the irradiance as the run leaves it.
/// @param page    Shows it, and may stop it.
/// @throws InputError if the bench has no light that could be pictured; BenchError if it was stopped.
void RunOnTwin(const Scenario& scenario, const RunFolder& folder, bool images, LivePage& page);

}  // namespace twinbench::tools
