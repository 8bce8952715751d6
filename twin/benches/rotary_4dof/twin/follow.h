#pragma once

#include <memory>

#include "twin/benches/rotary_4dof/twin/drives_along.h"
#include "twin/model/follow.h"

namespace twinbench::sim {

/// The rotary bench's twin on the course of a record; predictions are the four channels' block means [V].
///
/// Free, so zero until given at their points: the errors of both tables and what every mounting scatters. Where the
/// autocollimator was read, the grating is put to where it saw it, as the scenario's gain says.
/// @param drives  Not null; remembers what was driven, for those who ask with other light.
/// @throws InputError if a file that the scenario names cannot be read or does not fit.
std::unique_ptr<model::Follow> FollowRotary(const Scenario& scenario, const std::vector<Reading>& record,
                                            std::shared_ptr<DrivesOnce> drives);

}  // namespace twinbench::sim
