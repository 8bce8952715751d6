#pragma once

#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

namespace twinbench::procedure {

/// @throws InputError unless the comparison is made at stops: only that can be driven.
void RequireStops(const Scenario& scenario);

/// Carries the stops of a comparison out on any such bench: one rotary axis (the shaft), instruments that show what the
/// reference and the device say. A pass comes to its first stop from behind, over half the way from stop to stop; every
/// stop is read when it is due, never sooner than half an interval behind the move.
/// @throws what CarryOutPlan throws; InputError as RequireStops; DeviceFault kRefused for a bench with other axes, and for
///         several heads on a real bench, whose instruments show one.
void DriveComparison(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                     const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
