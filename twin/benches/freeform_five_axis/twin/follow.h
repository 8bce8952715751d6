#pragma once

#include <memory>

#include "twin/model/follow.h"

namespace twinbench::sim {

/// Points: every error of the machine ("x.tx" ... "b.rz", "syx" ... "sbz"), how the artefact stands ("mount.tx" ...
/// "mount.rz"), the spot on the quadrant detector, the height of the surface, and the channels.
std::unique_ptr<model::Follow> FollowFreeform(const Scenario& scenario, const std::vector<Reading>& record);

}  // namespace twinbench::sim
