#pragma once

#include "twin/benches/circular_motion/settings.h"

namespace twinbench::benches::circular {

/// Standard deviation of one reading as the scenario states it: of the instrument, its quantum, and the machine.
struct StatedNoise {
  double radial_m, tangential_m;
};
StatedNoise StatedNoiseOf(const CircularSettings& settings, bool is_bar, double radius_m);

}  // namespace twinbench::benches::circular
