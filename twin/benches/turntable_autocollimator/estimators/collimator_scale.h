#pragma once

#include <Eigen/Core>

#include "twin/core/scenario.h"

/// What the scenario says of the autocollimator's scale, taken out of its readings.
namespace twinbench::separate::turntable {

/// The mirror's angles from those that the autocollimator shows [rad]: its gain is 1 + g, and its optics enlarge by
/// 1 + (e / R) (angle / R)^2, e the error at the edge R of its range. Zero where the scenario says so.
Eigen::Vector2d MirrorAngles_rad(const Eigen::Vector2d& shown_rad, const Scenario& scenario);

}  // namespace twinbench::separate::turntable
