#pragma once

#include "twin/benches/hob_transmission/estimators/transmission_error.h"
#include "twin/benches/hob_transmission/estimators/visibility.h"

namespace twinbench::separate::hob {

/// The published method: only order 1 of the encoder's error is looked for.
struct TwoPositions {
  OrderStatus status =
      OrderStatus::kSumOnly;  // kSumOnly: both heads stand at the same place, the rest is not filled
  double noise_factor = kNaN;
  Coefficient encoder;       // order 1 of psi in the encoder's own angle (equation 14)
  Coefficient transmission;  // order 1 of e_T
  HarmonicSeries corrected;  // e_T of equation 15: the first position's orders, order 1 replaced
};

/// Psi = (E_1 - E_2) / (exp(-j alpha_1) - exp(-j alpha_2)),  e_T = m_1 - IDFT{ Psi exp(-j alpha_1) }.
///
/// @param first, second  Two set-ups in the same direction, both kOk.
/// @param u_head_rad     Standard uncertainty of each head angle.
/// @throws std::logic_error if the positions have no orders or differ in direction.
///
/// Uncertainty: readings and head angles, first order. Not included: orders 2 and up of the encoder's error, which
/// stay in `corrected` as the method assumes that there are none (SeparateHeads tells).
/// Reference: Tan et al., equations 13 to 15.
TwoPositions SeparateTwoPositions(const PositionError& first, const PositionError& second, double u_head_rad = 0.0,
                                  const SeparationLimits& limits = {});

}  // namespace twinbench::separate::hob
