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

/// What a pole 1 / (1 + i f / corner) makes of a sine, beside showing it `lag_s` late, as it does with all that is
/// slow: less of it, and less late.
struct BehindPole {
  double share = 1.0;      // of its amplitude
  double ahead_rad = 0.0;  // of a sine that is only lag_s late
};

/// @param lag_s  1 / (2 pi corner); 0: all passes.
inline BehindPole SineBehindPole(double frequency_Hz, double lag_s) {
  const double turned_rad = units::turn * frequency_Hz * lag_s;
  return {1.0 / std::hypot(1.0, turned_rad), turned_rad - std::atan(turned_rad)};
}

/// Mean of exp(-t / constant_s) over a time about `t_s`.
inline double DecayMean(double t_s, double constant_s, double averaged_s) {
  const double half = 0.5 * averaged_s / constant_s;
  return half < 1e-8 ? std::exp(-t_s / constant_s)
                     : (std::exp(half - t_s / constant_s) - std::exp(-half - t_s / constant_s)) / (2.0 * half);
}

/// The same behind a pole that showed 1 at time 0, whichever of the two is slower.
inline double DecayMeanBehindPole(double t_s, double constant_s, double averaged_s, double lag_s) {
  if (lag_s == 0.0) return DecayMean(t_s, constant_s, averaged_s);
  if (std::abs(lag_s / constant_s - 1.0) < 1e-6) lag_s *= 1.0 + 2e-6;  // a double pole is the limit
  return (constant_s * DecayMean(t_s, constant_s, averaged_s) - lag_s * DecayMean(t_s, lag_s, averaged_s)) /
         (constant_s - lag_s);
}

}  // namespace twinbench::model
