#pragma once

#include <functional>

#include "twin/core/devices.h"
#include "twin/core/scenario.h"

namespace twinbench::procedure {

/// How far a run has come; `bench_time` is on the bench's own clock.
struct Progress {
  int readings_done = 0;
  int readings_planned = 0;
  Phase phase = Phase::kFullCircle;
  Time bench_time{};
};
using ProgressCallback = std::function<void(const Progress&)>;

/// Carries out the phases of `scenario.procedure` in their order on any bench: the twin, hardware or a recording.
///
/// Every reading goes to `sink` as soon as it is made, numbered from 0. Dwell times are drawn from
/// `procedure.dwell_s` with Stream(seed, "procedure.dwell"), so a seed fixes the whole schedule.
///
/// @throws BenchError from the devices; what was appended before stays in the sink.
/// Reference: Jywe et al., IJMTM 47 (2007) 1978-1987, section 4: calibration, stability, verification, full circle.
void CarryOut(RotaryBench& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress = {});

/// How many readings CarryOut will make.
int PlannedReadings(const ProcedureSettings& procedure);

}  // namespace twinbench::procedure
