#pragma once

#include "twin/benches/circular_motion/twin/bodies.h"
#include "twin/model/follow.h"

namespace twinbench::sim {

/// The circles' twin on the course of a record; the prediction is the radial and tangential deviation from the
/// commanded point [m]. Points: offset_x, offset_y (of the centre, as bar or grid sees it), rotation (of the
/// encoder's zero, or of the grid), length (of the bar), x, y (of the spindle), radial, tangential (of what is
/// shown).
/// @param bodies  Axes that are bodies are run anew only if they are not in it.
std::unique_ptr<model::Follow> FollowCircles(const Scenario& scenario, const std::vector<Reading>& record,
                                             const std::shared_ptr<BodiesOnce>& bodies);

}  // namespace twinbench::sim
