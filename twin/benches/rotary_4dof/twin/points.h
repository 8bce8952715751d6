#pragma once

#include <array>
#include <vector>

#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {

/// What disturbances add to one reading of the rotary bench.
struct RotaryExtra {
  PoseState pose;
  LightState light;                         // differences from what the bench has
  std::array<double, kChannels> shown_m{};  // on the PSDs' surfaces
  mechanics::PoseError mount;               // of the grating on whatever carries it, unseen by the autocollimator
  mechanics::PoseError seat;                // of the reference's body, in its own frame
};

using RotaryPoint = BenchPoint<RotaryExtra>;

/// All of them, the points of a reading first.
const std::vector<RotaryPoint>& RotaryPoints();

}  // namespace twinbench::sim
