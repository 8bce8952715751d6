#include "twin/benches/circular_motion/stated_noise.h"

#include <cmath>

namespace twinbench::benches::circular {

StatedNoise StatedNoiseOf(const CircularSettings& s, bool is_bar, double radius_m) {
  const auto with_machine = [&](double noise_m) { return std::hypot(noise_m, s.machine.noise_m); };
  if (!is_bar) return {with_machine(s.grid.noise_m), with_machine(s.grid.noise_m)};
  const double quantum = 1.0 / std::sqrt(12.0), step_rad = units::turn / s.encoder.lines / s.encoder.interpolation;
  return {with_machine(std::hypot(s.bar.noise_m, quantum * s.bar.resolution_m)),
          with_machine(radius_m * std::hypot(s.encoder.noise_rad, quantum * step_rad))};
}

}  // namespace twinbench::benches::circular
