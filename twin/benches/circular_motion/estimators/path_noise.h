#pragma once

#include <vector>

#include "twin/benches/circular_motion/estimators/circle_path.h"

/// The noise of the radii of a pass as its readings show it.
namespace twinbench::separate::circular {

/// Paths whose radii have the noise that they scatter by, not what the scenario states: by their third differences along the pass, and
/// not below what the steps of their values make of it. Passes too short for that keep what is stated.
std::vector<CirclePath> WithNoiseAsRead(std::vector<CirclePath> paths);

}  // namespace twinbench::separate::circular
