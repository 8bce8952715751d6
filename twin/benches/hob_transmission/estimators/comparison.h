#pragma once

#include <vector>

#include "twin/benches/hob_transmission/estimators/head_positions.h"

/// Against an interferometer, which knows nothing of the ring.
namespace twinbench::separate::hob {

/// One order of two results that should be the same.
struct OrderComparison {
  int order = 0;
  OrderStatus status = OrderStatus::kSeparated;  // kSumOnly: the estimate still has the encoder's share in it
  Coefficient estimated = {};
  Coefficient reference = {};
  Coefficient difference = {};  // estimated - reference
  double amplitude_difference_rad = kNaN;
  double u_amplitude_difference_rad = kNaN;
  double phase_difference_rad = kNaN;  // (-pi, pi]
  double u_phase_difference_rad = kNaN;
  /// |difference| over its expanded uncertainty (k = 2) in that direction; above 1: they are not the same.
  double normalised_error = kNaN;
};

/// Takes both as independent. If they saw the same turns, what differs from turn to turn is in both, and the
/// uncertainty of the difference is on the safe side.
/// @param orders  Those that either does not have are left out.
std::vector<OrderComparison> CompareOrders(const HarmonicSeries& estimated, const HarmonicSeries& reference,
                                           const std::vector<int>& orders);

/// e_T of one direction as the interferometer saw it: mean over the set-ups.
/// @param positions  From MeasurePositions(kInterferometer).
/// @return empty if no set-up has a complete turn in this direction.
HarmonicSeries TransmissionByInterferometer(const std::vector<PositionError>& positions, int direction);

/// psi in the encoder's own angle: mean over set-ups and directions, each turned back by its head angle.
/// @param positions  From MeasurePositions(kEncodersMinusInterferometer).
HarmonicSeries EncoderByInterferometer(const std::vector<PositionError>& positions);

/// e_T of one direction against the interferometer; orders that are not told apart carry their status.
std::vector<OrderComparison> CompareTransmission(const HeadSeparation& separation, int direction,
                                                 const HarmonicSeries& interferometer,
                                                 const std::vector<int>& orders = {1, 22, 44});

/// psi against the interferometer (figure 8 of the paper); only orders that are told apart.
std::vector<OrderComparison> CompareEncoder(const HeadSeparation& separation, const HarmonicSeries& interferometer,
                                            const std::vector<int>& orders = {1});

}  // namespace twinbench::separate::hob
