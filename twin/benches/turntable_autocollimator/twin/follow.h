#pragma once

#include <memory>
#include <vector>

#include "twin/model/follow.h"

namespace twinbench::sim {

class ImagesOnce;

/// The turntable bench's twin on the course of a record; predictions are x and y of the autocollimator [rad].
///
/// Free, so zero until given at their points: the errors of both tables and of single teeth. What a mounting
/// scatters enters at "mount" and "axis". The edge of the range is taken a tenth further out, so that no reading
/// that was made there is missing.
/// @param images  Shared with others that follow the same record; may be null.
/// @throws InputError if a file that the scenario names cannot be read or does not fit.
std::unique_ptr<model::Follow> FollowTurntable(const Scenario& scenario, const std::vector<Reading>& record,
                                               const std::shared_ptr<ImagesOnce>& images = nullptr);

}  // namespace twinbench::sim
