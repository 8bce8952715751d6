#pragma once

#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

namespace twinbench::procedure {

/// @throws InputError for a spindle that coasts: nothing that can be asked of a machine lets go of its drive.
void RequireDriven(const Scenario& scenario);

/// Carries a comparison out on any such bench: one rotary axis (the shaft), instruments that show at one instant what the
/// reference and the device say.
///
/// Stops: a pass comes to its first stop from behind, over half the way from stop to stop; every stop is read when it is
/// due, never sooner than half an interval behind the move. Sweeps: the shaft goes over to its speed and back to rest, and
/// the instruments are read at every interval meanwhile. On a real bench the times of a pass count from where it began, and
/// its readings have no velocity: the reference's angles and times tell it. A resumed pass is gone again from its beginning.
/// @throws what CarryOutPlan throws; InputError as RequireDriven; DeviceFault kRefused for a bench with other axes, and for
///         several heads on a real bench, whose instruments show one.
void DriveComparison(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                     const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
