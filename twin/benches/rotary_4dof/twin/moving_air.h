#pragma once

#include <array>
#include <vector>

#include "twin/benches/rotary_4dof/twin/light.h"
#include "twin/sim/beam_wander.h"

namespace twinbench::sim {

/// Moving air between laser, grating and detectors. Over a way of L metres light arrives aside by
/// optics.wander x sqrt(L) x L, root mean square in each direction: every metre turns it anew. The way to the
/// grating belongs to both detectors and is a pointing error of the laser; behind it each arm has its own air.
/// Not included: that light arrives at the grating somewhat more oblique than such a pointing error says.
class MovingAir {
 public:
  MovingAir(const RotarySettings& bench, std::uint64_t seed);

  double Shortest_s() const;
  void Turn(Time now, LightState& light) const;
  void Move(Time now, Spots& spots) const;

 private:
  bool IsStill() const { return on_psds_.empty(); }

  std::vector<BeamWander> of_laser_;  // yaw, pitch [rad]
  std::vector<BeamWander> on_psds_;   // one a channel [m]
};

}  // namespace twinbench::sim
