#pragma once

#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

namespace twinbench::procedure {

/// Carries a scenario's poses out on any such bench: axes X, Y, Z, A, B, instruments that show the bench's columns.
/// Every pose is gone to straight from the one before it, at rest when it is due.
/// @throws what CarryOutPlan throws.
void DriveFreeform(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                   const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
