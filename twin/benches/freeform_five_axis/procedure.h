#pragma once

#include <vector>

#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

namespace twinbench::procedure {

/// The readings that a run will take: every set-up's poses forth and back, without what will be shown.
///
/// A pose: cell, A, B and height off the surface are drawn; X, Y and Z follow so that the ideal beam meets the cell
/// at normal incidence; then X, Y, A and B are moved a little, known by as much, because a probe that always reads
/// near zero does not show its own gain. Commanded values are whole millionths of a mm or degree.
/// Single path: the cells along X, those along Y, A alone and B alone, a quarter of the poses each.
std::vector<Reading> FreeformSchedule(const Scenario& scenario);

/// Carries a scenario's poses out on any such bench: axes X, Y, Z, A, B, instruments that show the bench's columns.
/// Every pose is gone to straight from the one before it, at rest when it is due.
/// @throws what CarryOutPlan throws.
void DriveFreeform(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                   const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
