#pragma once

#include "twin/benches/encoder_comparison/estimators/comparison_fit.h"

namespace twinbench::separate::encoder {

/// Means of the readings, with what passes and the reference have taken out, by angle of the device. One entry a
/// part of the turn that has readings.
struct AngleMeans {
  std::vector<double> position_rad;  // mean of the readings' angles, 0 to 2 pi, ascending
  std::vector<double> value_rad;
  std::vector<double> u_rad;  // standard deviation / sqrt(count), and what rounding repeats; NaN with one reading
  std::vector<int> count;
  double rounded_rad2 = 0.0, visits = 1.0;  // of the squares of u, what rounding repeats at a place of so many readings
};

/// Unlike the curves they have all orders that the readings have: what they show beside the curves is above the
/// highest order. `parts` parts of a turn; stops that are further apart stay by themselves.
/// @param direction  +1, -1; 0: both.
AngleMeans MeansOf(const ComparisonFit& fitted, int direction, int parts);

}  // namespace twinbench::separate::encoder
