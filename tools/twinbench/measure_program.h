#pragma once

#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/measured_run.h"

namespace twinbench::tools {

/// `measure` on a bench that is a program of the user's: it gets the scenario and the stops, and writes readings.
void MeasureByProgram(const MeasureOptions& options, const Scenario& scenario, LivePage& page, JsonAnswer& answer);

}  // namespace twinbench::tools
