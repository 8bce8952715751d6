#pragma once

#include "tools/twinbench/run_folder.h"

namespace twinbench::tools {

/// Carries out a scenario of any bench on its twin: makes the folder with resolved scenario, truth and record.
/// @param images  Write the irradiance as the run leaves it.
/// @throws InputError if the bench has no light that could be pictured.
void RunOnTwin(const Scenario& scenario, const RunFolder& folder, bool images);

}  // namespace twinbench::tools
