#pragma once

#include <vector>

#include "twin/benches/hob_transmission/estimators/transmission_error.h"
#include "twin/benches/hob_transmission/estimators/visibility.h"

namespace twinbench::separate::hob {

struct HeadOptions {
  SeparationLimits limits = {};
  double u_head_rad = 0.0;  // standard uncertainty of each set-up's head angle
};

/// What all positions of one direction say together, told apart or not: sum = e_T + share x psi.
struct PositionSum {
  Coefficient sum;               // mean over the positions
  Complex share = {kNaN, kNaN};  // mean of exp(-j k head)
};

/// One order of the table's turn. Vectors have one entry a direction, as HeadSeparation::directions.
struct SeparatedOrder {
  int order = 0;
  OrderStatus status = OrderStatus::kSumOnly;
  double noise_factor = kNaN;                  // NoiseFactor for the readings that are there; the worst direction
  std::vector<Coefficient> transmission = {};  // e_T; NaN with kSumOnly
  Coefficient encoder = {};                    // psi in the encoder's own angle; NaN with kSumOnly
  std::vector<PositionSum> sum = {};

  // Against the stated covariances; dof 0: nothing to test.
  double chi2 = kNaN;  // of the model e_T + psi, with readings to spare
  int dof = 0;
  double chi2_alike = kNaN;  // of all positions seeing the same: psi = 0 in this order, as the published method
  int dof_alike = 0;         // assumes for 2 and up
};

struct HeadSeparation {
  std::vector<int> directions;         // +1, -1: those that were measured
  std::vector<SeparatedOrder> orders;  // [k - 1]
  int positions = 0;                   // used: set-ups x directions
  int left_out = 0;                    // without a complete turn
  double dof = kNaN;                   // behind the covariances, of the poorest position

  const SeparatedOrder& At(int order) const { return orders.at(static_cast<std::size_t>(order - 1)); }
};

/// Separates transmission error and encoder error from any number of head positions, order by order.
///
/// Per order k: weighted least squares on m_(p,d) = e_T,d + psi exp(-j k alpha_p), p set-up, d direction. Each
/// direction has a transmission error of its own (flanks, wind-up), the ring has one error. An order whose
/// transmission error would be less certain than the limits is not told apart: there is the sum, which the
/// transmission error is if the encoder has none. Order 0 is a matter of mounting and not there.
///
/// @param positions  From MeasurePositions(kEncoders); those that are not kOk are left out.
///
/// Uncertainty: readings and head angles, first order, and a floor for the second order (SecondOrder). Not
/// included: eccentricity or seating of the ring that changes with the set-up, which shows in chi2 from three
/// positions on only. Reference: docs/theory.md 2, where heads are shifts; two positions, order 1: Tan et al.,
/// equations 13 to 15.
HeadSeparation SeparateHeads(const std::vector<PositionError>& positions, const HeadOptions& options = {});

/// e_T of one direction as far as it is told apart, and the sums elsewhere; the encoder's error, NaN elsewhere.
/// @throws std::logic_error if the direction was not measured.
HarmonicSeries TransmissionSeries(const HeadSeparation& separation, int direction);
HarmonicSeries EncoderSeries(const HeadSeparation& separation);

}  // namespace twinbench::separate::hob
