#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "twin/core/devices.h"
#include "twin/core/run_log.h"
#include "twin/core/scenario.h"
#include "twin/core/table_limits.h"

namespace twinbench::procedure {

/// How far a run has come; `bench_time` is on the bench's own clock.
struct Progress {
  int readings_done = 0;
  int readings_planned = 0;
  Phase phase = Phase::kFullCircle;
  Time bench_time{};
};
using ProgressCallback = std::function<void(const Progress&)>;

/// How careful to be, and where to begin.
struct Options {
  TableLimits target, reference;
  int attempts = 3;                        // at one reading, before the run stops
  double jump_V = std::numeric_limits<double>::infinity();  // between neighbouring stops of a pass; more: implausible
  double coldest_degC = -std::numeric_limits<double>::infinity();  // a thermometer beyond these is broken
  double hottest_degC = std::numeric_limits<double>::infinity();
  RunLog* log = nullptr;                   // none: only readings are kept, and the first fault ends the run
  std::function<bool()> stop_requested;    // asked between moves, waits and readings

  int readings_done = 0;                   // a resumed run begins behind these ...
  std::vector<DeviceCall> calls_done = {}; // ... on a simulated bench by doing these again
};

/// Carries out the phases of `scenario.procedure` in their order on any bench: the twin, hardware or a recording.
///
/// Every reading goes to `sink` as soon as it is made, numbered from 0. Dwell times are drawn from
/// `procedure.dwell_s` with Stream(seed, "procedure.dwell"), so a seed fixes the whole schedule.
///
/// A fault of a device costs an attempt: the tables are stopped, the bench is brought back to how it was behind the
/// last reading that was kept, and the way to the next one is gone again. A simulated bench does so to the bit (it
/// starts again and repeats its calls), a real one by reading its encoders and approaching the last stop from the
/// side it was approached from. Stalls, following errors, limits, implausible readings, lost signals and the operator
/// end the run at once; it can be resumed.
///
/// @throws DeviceFault when no attempt is left or the fault is none to try again; both tables were stopped, and what
///         was appended before stays in the sink. BenchError, InputError from devices and sink.
/// Reference: Jywe et al., IJMTM 47 (2007) 1978-1987, section 4: calibration, stability, verification, full circle.
void CarryOut(RotaryBench& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress = {}, const Options& options = {});

/// How many readings CarryOut will make.
int PlannedReadings(const ProcedureSettings& procedure);

}  // namespace twinbench::procedure
