#pragma once

#include <span>
#include <vector>

#include "twin/investigate/free_sizes.h"
#include "twin/investigate/joint_fit.h"

namespace twinbench::investigate {

/// Evidence and uncertainties of a fit that has ended: by Laplace's approximation, and summed where slopes say
/// little - near a bound, and where something happened at one reading.
/// @param normal  Of the sizes, at the fit.
void StateCertainty(const std::vector<Size>& sizes, Normal normal, std::span<const TakenRun> runs,
                    const Means& means, JointFit& fit);

}  // namespace twinbench::investigate
