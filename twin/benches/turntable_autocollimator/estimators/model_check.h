#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/harmonic_model.h"

namespace twinbench::separate::turntable {

/// Size of a set of indexing errors.
struct ErrorSize {
  int count = 0;
  double peak_to_valley_rad = kNaN;
  double rms_rad = kNaN;                 // about the mean
  double largest_rad = kNaN;             // largest deviation from the mean
  double largest_from_start_rad = kNaN;  // largest deviation from the first: the maximum of a zero-start curve
};

/// Sizes of errors in the order of the positions; NaN are left out, NaN without any.
ErrorSize DescribeErrors(const Eigen::VectorXd& error_rad);

/// What is left of the indexing error at check positions when the model is taken out of the readings: the model's
/// own test. Whether a table comes to where it should with a compensation at work only a measurement with it shows
/// (separate/compensation.h).
struct ModelCheck {
  std::vector<double> position_rad;  // distinct turntable angles, ascending
  Eigen::VectorXd error_rad;         // mean of their readings, corrected for roll, less the set-ups' means
  Eigen::VectorXd rest_rad;          // the same for error less model
  ErrorSize before;
  ErrorSize after;
  double expected_rms_rad = kNaN;  // of `after`, from the uncertainties of model and check
};

/// Uncertainty of the check itself: of one reading, and of a tooth, which further readings do not average.
struct CheckUncertainty {
  double u_reading_rad = 0.0;
  double u_multitooth_rad = 0.0;
};

/// Compares a model with readings at any positions, which need no grid.
///
/// @param stops  Check readings, at positions that the model was not fitted to.
/// @param roll   Of the crosshair, unchanged since; not taken out if it is not known.
ModelCheck CheckModel(const HarmonicModel& model, const std::vector<TurntableStop>& stops, const Roll& roll,
                      const CheckUncertainty& u);

}  // namespace twinbench::separate::turntable
