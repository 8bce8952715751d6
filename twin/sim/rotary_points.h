#pragma once

#include <array>
#include <vector>

#include "twin/model/follow.h"
#include "twin/sim/effect.h"

namespace twinbench::sim {

/// What disturbances add to one reading of the rotary bench.
struct RotaryExtra {
  PoseState pose;
  LightState light;                      // differences from what the bench has
  std::array<double, kChannels> shown_m{};  // on the PSDs' surfaces
  mechanics::PoseError mount;            // of the grating on whatever carries it, unseen by the autocollimator
};

/// A point of the rotary bench: either it enters a reading, or it is a constant of the bench.
struct RotaryPoint {
  model::Point point;
  double& (*of_reading)(RotaryExtra&) = nullptr;  // this ...
  double& (*of_bench)(Scenario&) = nullptr;       // ... or this
};

/// All of them, the points of a reading first.
const std::vector<RotaryPoint>& RotaryPoints();

}  // namespace twinbench::sim
