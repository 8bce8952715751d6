#pragma once

#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

namespace twinbench::procedure {

/// Carries a scenario's stops out on any such bench: one rotary axis (the turntable), an autocollimator's x and y among
/// the instruments, and an indexer unless a polygon stands on the turntable.
///
/// Every pass comes from behind its first stop. The multi-tooth table is seated anew at every stop, while the turntable
/// moves unless somebody turns it by hand. With a polygon the turntable is turned until the autocollimator shows zero of
/// the face, or as little as it comes to, and the reading's turntable angle is what its encoder shows then; a face that is
/// not seen is read as it is.
/// @throws what CarryOutPlan throws; DeviceFault kRefused for a bench with other axes or without an indexer.
void DriveTurntable(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                    const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
