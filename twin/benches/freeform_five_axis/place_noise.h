#pragma once

#include <array>

#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/scenario.h"

namespace twinbench::benches::freeform {

/// How well the readings at one pose say where each axis stood, were it the only one in doubt [m, rad]: standard
/// uncertainty from the noise of quadrant detector and camera, of both readings that every pose is given (forth and
/// back), as the root of the mean information over the poses of the plan.
///
/// Of the machine as it should be, by central differences of the estimators' model of the probe.
std::array<double, kMachineAxes> PlaceNoise(const Scenario& scenario);

}  // namespace twinbench::benches::freeform
