#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/noise.h"
#include "twin/benches/turntable_autocollimator/estimators/shift_fit.h"

namespace twinbench::separate::turntable {

enum class RollStatus {
  kOk,
  kGiven,         // by the caller
  kTiltsAlike,    // y follows position, tooth and set-up but for noise: no change of tilt that would show the roll
  kTiltsHidden,   // position, tooth and set-up would follow any tilts of these set-ups
  kNoiseNotKnown  // a single reading is left over, which tells no roll from noise
};

/// Roll of the autocollimator's crosshair against the turntable's axis: x' = (x + y' sin g) / cos g (eq. 1).
struct Roll {
  RollStatus status = RollStatus::kTiltsHidden;
  double gamma_rad = kNaN;
  double u_gamma_rad = kNaN;
  double tilt_rms_rad = kNaN;  // of the part of y that shows the roll
  double attenuation = kNaN;   // of the slope by the noise of y; taken out

  /// Angle about the turntable's axis; x where the roll is not known.
  double Correct(double x_rad, double y_rad) const;
};

/// Roll from all readings at once: the slope of x on y, both without what position, tooth and set-up explain.
///
/// Two set-ups of equal shift and different tilt give tan g = sum(dx dy) / sum(dy^2) over the differences of the
/// two without their means. Several shifts need three set-ups, since two tell tooth and turntable apart and no
/// more. What is left of y shows the roll if it is more than noise would leave (p < 0.001).
///
/// @param x_rad, y_rad  One a stop of the grid.
/// @param noise  Of one reading. If not known (NaN) it is taken from the fit, equal in x and y.
/// Uncertainty: noise of both axes, first order. Not included: a tilt that changed inside a set-up together with
/// the indexing error, nonlinearity of the autocollimator. Reference: Guo et al. (2014) eq. 1, 2, 4; errors in both
/// variables as in Fuller, Measurement Error Models, 1.2.
Roll EstimateRoll(const ShiftFit& fit, const Eigen::VectorXd& x_rad, const Eigen::VectorXd& y_rad,
                  const AutocollimatorNoise& noise);

/// The same for stops as read, with the noise of their repeats unless it is stated.
Roll EstimateRoll(const std::vector<TurntableStop>& stops, const AutocollimatorNoise& stated = {},
                  int positions = 0);

}  // namespace twinbench::separate::turntable
