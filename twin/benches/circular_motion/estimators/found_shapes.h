#pragma once

#include "twin/benches/circular_motion/estimators/rigorous.h"

/// Lengths and times that a scenario states and the readings know better: a pitch that is not that of the error is no error, and
/// what it leaves is taken for backlash and scale.
namespace twinbench::separate::circular {

/// The same constants with the pitch of cyclic errors or the time of spikes behind reversals, whichever explains more, with which
/// much of what is left is explained; as they were where neither explains plainly more than the one so far.
/// @param fit  With these constants.
CircleConstants WithShapeAsRead(const std::vector<CirclePoint>& points, const CircleFit& fit, const CircleConstants& known);

}  // namespace twinbench::separate::circular
