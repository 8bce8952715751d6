#pragma once

#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/measured_run.h"

namespace twinbench::tools {

/// `measure` of a bench whose machine is driven (Bench::drive).
void MeasureMachine(const MeasureOptions& options, const Scenario& scenario, LivePage& page, JsonAnswer& answer);

}  // namespace twinbench::tools
