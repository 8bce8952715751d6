#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/stream.h"

namespace twinbench::sim {

/// What the grating's roughness does to the spots' centroids: the same displacement whenever the grating stands the
/// same way, another one as it turns.
///
/// Each channel's displacement is a normal field over the grating's yaw and tilt with the correlation
/// exp(-(turn / correlation)^2), a sum of plane waves with normal wave vectors. It follows the turn alone: a spot
/// of half a millimetre stays on its place of the grating to some micrometres. Reference: Goodman, Speckle
/// Phenomena in Optics (2007), 5 (decorrelation by a turn of the surface).
class Speckle {
 public:
  Speckle(const GratingSettings& grating, std::uint64_t seed);

  void Move(const Pose& X_LG, std::array<double, kChannels>& spots_m) const;

 private:
  struct Wave {
    double by_yaw, by_tilt, phase_rad;
  };
  static std::vector<Wave> WavesOf(const GratingSettings& grating, Stream& stream);

  double amplitude_m_;
  std::array<std::vector<Wave>, kChannels> waves_;
};

}  // namespace twinbench::sim
