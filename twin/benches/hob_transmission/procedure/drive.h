#pragma once

#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

namespace twinbench::procedure {

/// Carries a scenario's passes out on any such bench: one rotary axis that turns on and on (the hob, whose drive takes
/// the table along), counters of both encoders that latch at lines of the table's.
///
/// A pass runs up, keeps its samples, runs down and rests; those of a look into the memory become readings together. At
/// stops every one is approached in the direction of the pass. A resumed real run makes the rest of a pass from wherever
/// the table stands.
/// @throws what CarryOutPlan throws; DeviceFault kRefused for a bench with other axes.
void DriveHob(MachineBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress,
              const MachineOptions& options);

}  // namespace twinbench::procedure
