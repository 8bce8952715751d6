#pragma once

#include <memory>

#include "hw_bridge/open_bench.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/measured_run.h"

namespace twinbench::tools {

/// Carries a scenario out on what the bench file names and evaluates it.
/// @param page    Shows it.
/// @param answer  Gets what came of it, or of the rehearsal alone; nothing where nobody asks.
/// @throws BenchError if it stopped before its end; what was read is kept.
void Measure(const MeasureOptions& options, LivePage& page, JsonAnswer& answer);

/// `measure` of a bench whose machine is driven (Bench::drive).
void MeasureMachine(const MeasureOptions& options, const Scenario& scenario, LivePage& page, JsonAnswer& answer);

/// `measure` on a bench that is a program of the user's: it gets the scenario and the stops, and writes readings.
void MeasureByProgram(const MeasureOptions& options, const Scenario& scenario, LivePage& page, JsonAnswer& answer);

/// Opens the bench that a bench file names, whatever kind it is of: hardware, the program's own twin, a recording.
/// @param elapsed  How long ago Time 0 of the run was.
std::unique_ptr<hw::OpenBench> OpenAnyBench(const hw::BenchFile& file, const Scenario& scenario, Duration elapsed);

}  // namespace twinbench::tools
