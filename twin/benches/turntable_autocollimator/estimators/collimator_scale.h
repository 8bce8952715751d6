#pragma once

#include <Eigen/Core>

#include "twin/core/scenario.h"

namespace twinbench {
struct TurntableSettings;
}

/// What the scenario says of the autocollimator's scale and of the mirror, taken out of its readings.
namespace twinbench::separate::turntable {

/// The mirror's angles from those that the autocollimator shows [rad]: its gain is 1 + g, and its optics enlarge by
/// 1 + (e / R) (angle / R)^2, e the error at the edge R of its range. Zero where the scenario says so.
Eigen::Vector2d MirrorAngles_rad(const Eigen::Vector2d& shown_rad, const Scenario& scenario);

/// What a beam does that meets a hollow mirror, or face, off its middle: yaw [rad]. A mounting that the scenario
/// does not have is as its last one.
double BeamWalk_rad(const TurntableSettings& own, int setup, double turntable_rad);

}  // namespace twinbench::separate::turntable
