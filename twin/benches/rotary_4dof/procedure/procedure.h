#pragma once

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/devices.h"
#include "twin/core/scenario.h"
#include "twin/procedure/options.h"

namespace twinbench::procedure {

/// Carries out the phases of `scenario.procedure` in their order on any bench: the twin, hardware or a recording.
///
/// Every reading goes to `sink` as soon as it is made, numbered from 0. Dwell times are drawn from
/// `procedure.dwell_s` with Stream(seed, "procedure.dwell"), so a seed fixes the whole schedule.
///
/// A fault of a device costs an attempt: the tables are stopped, the bench is brought back to how it was behind the
/// last reading that was kept, and the way to the next one is gone again. A simulated bench does so to the bit (it
/// starts again and repeats its calls), a real one by reading its encoders and approaching the last stop from the
/// side it was approached from. Stalls, following errors, limits, implausible readings, lost signals and the
/// operator end the run at once; it can be resumed.
///
/// @throws DeviceFault when no attempt is left or the fault is none to try again; both tables were stopped, and
/// what
///         was appended before stays in the sink. BenchError, InputError from devices and sink.
/// Reference: Jywe et al., IJMTM 47 (2007) 1978-1987, section 4: calibration, stability, verification, full circle.
void CarryOut(RotaryBench& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress = {}, const Options& options = {});

/// How many readings CarryOut will make.
int PlannedReadings(const ProcedureSettings& procedure);

}  // namespace twinbench::procedure
