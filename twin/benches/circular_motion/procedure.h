#pragma once

#include <vector>

#include "twin/benches/circular_motion/settings.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

namespace twinbench::procedure {

/// The readings that circles will take: when, where and how fast; what is shown is still empty. Of each set-up the
/// sweeps, feed by feed in all directions, then the stops in all directions.
///
/// Every pass begins at start_deg behind half a circle and more of lead-in, in motion since. `position` counts up
/// with the angle in both directions: the one at start_deg is 0.
std::vector<Reading> CircleSchedule(const CircularProcedureSettings& procedure);

/// Carries a scenario's circles out on any such bench: axes X and Y, instruments that show the bench's columns.
///
/// Between the mountings the machine goes straight; with an instrument mounted it never leaves the circle, for the
/// bar's stroke is a millimetre or two. A sweep is led in by half a circle at its own feed; every stop is reached
/// from the one before it, also the first.
/// @throws what CarryOutPlan throws; kImplausible if a resumed bench does not stand on its circle.
void DriveCircles(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                  const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
