#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/noise.h"

/// Equation 5 of Guo et al. (2014): the roll of the crosshair eliminated position by position from two tilts.
namespace twinbench::separate::turntable {

enum class PointStatus {
  kOk,
  kNearPole,  // noise is magnified more than kPoleMagnification times, or the two tilts differ by no more than
              // noise
  kMissing    // not read in both set-ups
};

/// A tilt that turns with the turntable differs from another as a cosine once a turn, counted from the start: the
/// equation has a pole where that comes back to zero, and is 0 / 0 at the start.
inline constexpr double kPoleMagnification = 5.0;

struct PointwiseError {
  double turntable_rad = kNaN;
  double value_rad = kNaN;      // zero at the first position that both set-ups read
  double u_rad = kNaN;          // first order: grows to a pole, where the true scatter has no variance; and cos g = 1
  double magnification = kNaN;  // sqrt(y_0^2 + y_1^2) / |y_1 - y_0|
  PointStatus status = PointStatus::kMissing;
};

/// x_i = (y_1i x_0i - y_0i x_1i) / (y_1i - y_0i), as published: cos g = 1, and the roll needs no estimate.
///
/// @param first, second  Labels of two set-ups of equal shift and different tilt; means over their passes are
/// taken.
/// @param noise  Of one reading.
/// @return One entry a position. x and y of each set-up are counted from its first position (the paper's zero
/// start):
///         otherwise the constants of the set-ups, which the equation does not know, would enter. The value holds
///         the multi-tooth table's error as well.
/// @throws InputError if a set-up is not there, the shifts differ or no position is common; as FindGrid.
std::vector<PointwiseError> SolveEquation5(const std::vector<TurntableStop>& stops, int first, int second,
                                           const AutocollimatorNoise& noise, int positions = 0);

}  // namespace twinbench::separate::turntable
