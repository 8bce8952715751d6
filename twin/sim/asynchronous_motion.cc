#include "twin/sim/asynchronous_motion.h"

#include <cmath>

#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

/// Of a wave's amplitude, before all are scaled to the stated root mean square.
double Size(double order) {
  return 1.0 / (1.0 + order);
}

}  // namespace

AsynchronousMotion::AsynchronousMotion(const AsynchronousSettings& s, std::uint64_t seed, const std::string& name) {
  const std::array<double, kMotions> rms = {s.radial_m, s.radial_m, s.axial_m, s.tilt_rad, s.tilt_rad};
  Stream stream(seed, name + ".asynchronous");
  double mean_square = 0.0;  // of the waves together
  for (int k = 0; k < kWaves; ++k) {
    Wave wave{};
    wave.order = k + 0.15 + 0.7 * stream.Uniform();
    mean_square += 0.5 * Size(wave.order) * Size(wave.order);
    for (std::size_t m = 0; m < kMotions; ++m) {
      const double phase_rad = 2.0 * units::kPi * stream.Uniform();
      wave.cosine[m] = Size(wave.order) * std::cos(phase_rad);
      wave.sine[m] = -Size(wave.order) * std::sin(phase_rad);
    }
    waves_.push_back(wave);
  }
  for (Wave& wave : waves_) {
    for (std::size_t m = 0; m < kMotions; ++m) {
      wave.cosine[m] *= rms[m] / std::sqrt(mean_square);
      wave.sine[m] *= rms[m] / std::sqrt(mean_square);
    }
  }
}

mechanics::BearingPose AsynchronousMotion::At(double rotor_rad) const {
  std::array<double, kMotions> sum{};
  for (const Wave& wave : waves_) {
    const double c = std::cos(wave.order * rotor_rad), s = std::sin(wave.order * rotor_rad);
    for (std::size_t m = 0; m < kMotions; ++m) sum[m] += c * wave.cosine[m] + s * wave.sine[m];
  }
  return {sum[0], sum[1], sum[2], sum[3], sum[4]};
}

}  // namespace twinbench::sim
