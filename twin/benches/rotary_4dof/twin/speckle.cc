#include "twin/benches/rotary_4dof/twin/speckle.h"

#include <cmath>
#include <string>

namespace twinbench::sim {
namespace {

constexpr int kWaves = 64;

}  // namespace

Speckle::Speckle(const GratingSettings& grating, std::uint64_t seed)
    : amplitude_m_(grating.speckle_m * std::sqrt(2.0 / kWaves)) {
  if (grating.speckle_m == 0.0) return;
  for (std::size_t c = 0; c < kChannels; ++c) {
    Stream stream(seed, std::string("grating.speckle.") + kChannelNames[c]);
    waves_[c] = WavesOf(grating, stream);
  }
}

std::vector<Speckle::Wave> Speckle::WavesOf(const GratingSettings& grating, Stream& stream) {
  const double spread = std::sqrt(2.0) / grating.speckle_correlation_rad;
  std::vector<Wave> waves;
  for (int k = 0; k < kWaves; ++k) {
    const double by_yaw = spread * stream.Normal(), by_tilt = spread * stream.Normal();
    waves.push_back({by_yaw, by_tilt, units::turn * stream.Uniform()});
  }
  return waves;
}

void Speckle::Move(const Pose& X_LG, std::array<double, kChannels>& spots_m) const {
  if (amplitude_m_ == 0.0) return;
  const Vector3 normal_L = X_LG.linear().col(1);
  const double yaw_rad = std::atan2(-normal_L.x(), normal_L.y());
  const double tilt_rad = std::atan2(normal_L.z(), std::hypot(normal_L.x(), normal_L.y()));
  for (std::size_t c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    for (const Wave& w : waves_[c]) sum += std::cos(w.by_yaw * yaw_rad + w.by_tilt * tilt_rad + w.phase_rad);
    spots_m[c] += amplitude_m_ * sum;
  }
}

}  // namespace twinbench::sim
