#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/units.h"
#include "twin/separate/series.h"

namespace twinbench::separate::hob {

enum class OrderStatus {
  kSeparated,
  kSumOnly,  // the positions see transmission error and encoder error of this order almost only as a sum
};

/// Factor from the standard uncertainty of one position's coefficient to that of the separated transmission error,
/// all positions equally good (formula V of docs/theory.md 2, with heads for shifts):
///
///   sqrt( p / (p^2 - |A|^2) ),  A = sum over the p heads of exp(-j k head);  two heads: sqrt(2) / (2 |sin(k beta /
///   2)|)
///
/// Infinite where the heads see the order alike: every even order at 180 deg, every third one at 0, 120, 240 deg;
/// with one head every order.
double NoiseFactor(int order, const std::vector<double>& head_rad);

/// When is an order told apart? Uncertainty decides, not an exact zero: 177 deg is nearly blind at order 2.
struct SeparationLimits {
  double max_u_rad = 0.5 * units::arcsec;  // twice the published agreement with an interferometer
  /// However quiet the readings: what the model leaves out, about 1 milliarcsec, is multiplied as well.
  double max_noise_factor = 100.0;
};

OrderStatus Judge(double noise_factor, double u_rad, const SeparationLimits& limits);

}  // namespace twinbench::separate::hob
