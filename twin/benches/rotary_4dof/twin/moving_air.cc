#include "twin/benches/rotary_4dof/twin/moving_air.h"

#include <cmath>
#include <limits>
#include <string>

namespace twinbench::sim {

MovingAir::MovingAir(const RotarySettings& bench, std::uint64_t seed) {
  const LightSettings& optics = bench.optics;
  if (optics.wander_rad == 0.0) return;
  const auto aside_rad = [&](double way_m) { return optics.wander_rad * std::sqrt(way_m); };
  for (const char* axis : {"yaw", "pitch"}) {
    of_laser_.emplace_back(aside_rad(bench.laser.position_m.norm()), optics.wander_corner_Hz, seed,
                           std::string("air.laser.") + axis);
  }
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double way_m = (c < 2 ? bench.psd_a : bench.psd_b).distance_m;
    on_psds_.emplace_back(aside_rad(way_m) * way_m, optics.wander_corner_Hz, seed,
                          std::string("air.") + kChannelNames[c]);
  }
}

double MovingAir::Shortest_s() const {
  return IsStill() ? std::numeric_limits<double>::infinity() : on_psds_.front().Shortest_s();
}

void MovingAir::Turn(Time now, LightState& light) const {
  if (IsStill()) return;
  light.yaw_rad += of_laser_[0].At(ToSeconds(now));
  light.pitch_rad += of_laser_[1].At(ToSeconds(now));
}

void MovingAir::Move(Time now, Spots& spots) const {
  if (IsStill()) return;
  for (std::size_t c = 0; c < kChannels; ++c) spots.uv_m[c] += on_psds_[c].At(ToSeconds(now));
}

}  // namespace twinbench::sim
