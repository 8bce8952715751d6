#pragma once

#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/angle_means.h"
#include "twin/benches/encoder_comparison/estimators/comparison_fit.h"
#include "twin/benches/encoder_comparison/estimators/reversal.h"
#include "twin/core/reading.h"

/// Front door of the bench encoder_comparison: from readings to the error of the device over its own angle.
namespace twinbench::separate::encoder {

/// One pass: where the device stood and how far it moved on against its own curve.
struct PassResult {
  int setup = 0, pass = 0, direction = 1, readings = 0;
  double turns = kNaN;
  double constant_rad = kNaN;        // measured - reference in its middle and at its mean speed, without the curve
  double slope_rad_per_turn = kNaN;  // NaN: less than one and a half turns, not told from the curve
};

struct DeviceError {
  int used = 0, left_out = 0;  // readings
  int highest_order = 0;       // 0: no curve; `not_separated` says why, and the rest is empty
  std::string not_separated;

  SeparatedCurves curves;
  std::vector<PassResult> passes;
  std::vector<double> mounting_rad;    // device angle where the reference shows 0, of each set-up used
  MeanReversal reversal;               // the mean that the curve `reversal` has not
  AngleMeans both, forward, backward;  // what was read, by degrees
  double lag_s = kNaN,
         u_lag_s = kNaN;            // of the device behind the reference, from changes of the speed within passes
  double residual_rms_rad = kNaN;   // of a reading about its fit: noise, and what does not repeat
  double low_order_scatter = kNaN;  // order 1 scatters so many times more between turns than white noise would
  double dof = kNaN;
  // [k - 1]: of the variance of order k, what white noise of the readings makes, what rounding repeats, and what
  // orders above the highest may add; 0 to 1
  std::vector<double> white_share, rounding_share, folded_share;
  std::vector<std::string> notes;
};

/// The series with these shares of its covariance, without what is not resolved.
harmonics::HarmonicSeries OfShare(harmonics::HarmonicSeries series, const std::vector<double>& share);

/// Takes measured - reference apart into the device's repeatable error, the reference's and what belongs to single
/// passes: a constant, a steady drift or a wrong scale (slope), a delay (lag).
///
/// A reading belongs to the device's angle th = reference (corrected by its own error where that is separated) +
/// mounting, the mounting being what the device shows more than the reference in the mean of its set-up: an
/// incremental device needs its mounting added to `measured` first. Curves are sums of orders without a mean: what
/// is constant over the turn depends on how the device was set to zero.
///
/// Readings at rest between sweeps (direction 0) are not used. Positions need not be even and readings may be
/// missing; both limit the highest order.
///
/// Uncertainty: scatter of each order between turns, or white noise where there is one turn only; besides it what
/// the steps of the device (stated, or those that its readings have in common) round alike in every pass, and
/// orders above the highest, as far as those below show them (Unresolved). Not included: what repeats every turn
/// with neither device nor reference (shaft and coupling count as the device), the angle at which D is read when
/// the shaft between both gives way.
DeviceError SeparateDevice(const std::vector<Reading>& readings, const DeviceOptions& options = {});

/// A curve at 0, 360 / points, ... deg [rad].
struct CurveAt {
  Eigen::VectorXd value_rad, u_rad;
};
CurveAt Curve(const harmonics::HarmonicSeries& series, int points);

}  // namespace twinbench::separate::encoder
