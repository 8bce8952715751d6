#pragma once

#include "twin/benches/encoder_comparison/estimators/scale_steps.h"
#include "twin/separate/position_error.h"

namespace twinbench::separate::encoder {

struct SeparatedCurves {
  // Of the device: mean of both directions (or the one there is), and forward - backward (empty with one
  // direction).
  harmonics::HarmonicSeries device, forward, backward, reversal;
  harmonics::HarmonicSeries reference;  // NaN in the orders of `lost`; empty if all are lost
  std::vector<int> lost;                // orders that the mountings see alike: counted as the device's
  double chi2 = 0.0;                    // against the stated covariances, from order 2 on: order 1 may change with the mounting
  int dof = 0;
  std::vector<int>
      disagreeing;  // orders in which the mountings contradict each other; their uncertainty is widened
};

/// Separates D and R order by order from what each mounting shows in each direction, x = D(th) - R(th - mounting):
/// least squares with a D for each direction and one R. An order is separated if equal noise on all readings
/// reaches the device at most `max_noise_factor` times as large; with one mounting none is.
///
/// Mountings that contradict each other in an order (p < 0.001 for the whole spectrum) have an error that changed
/// with the mounting, as an eccentricity does: its covariance is multiplied by chi2 / dof.
///
/// @param rounding  Of the same positions, besides their covariances; weights take it for independent of each other.
/// @param seen  Of all mountings, each with the device's angle where the reference shows 0 as its `head_rad`.
/// Reference: docs/theory.md 2, where mountings are shifts.
SeparatedCurves SeparateMountings(const std::vector<harmonics::PositionError>& seen, double max_noise_factor,
                                  const Rounding& rounding = {});

}  // namespace twinbench::separate::encoder
