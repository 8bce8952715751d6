#pragma once

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::model {

/// What is left of a sine's amplitude in its mean over a time about an instant: sin(pi f T) / (pi f T), which may
/// be negative.
inline double ShareLeft(double frequency_Hz, double averaged_s) {
  const double x = units::kPi * frequency_Hz * averaged_s;
  return std::abs(x) < 1e-8 ? 1.0 : std::sin(x) / x;
}

}  // namespace twinbench::model
