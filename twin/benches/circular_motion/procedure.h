#pragma once

#include <vector>

#include "twin/benches/circular_motion/settings.h"
#include "twin/core/reading.h"

namespace twinbench::procedure {

/// The readings that circles will take: when, where and how fast; what is shown is still empty. Of each set-up the
/// sweeps, feed by feed in all directions, then the stops in all directions.
///
/// Every pass begins at start_deg behind half a circle and more of lead-in, in motion since. `position` counts up
/// with the angle in both directions: the one at start_deg is 0.
std::vector<Reading> CircleSchedule(const CircularProcedureSettings& procedure);

}  // namespace twinbench::procedure
