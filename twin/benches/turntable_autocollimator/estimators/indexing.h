#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/noise.h"
#include "twin/benches/turntable_autocollimator/estimators/roll.h"
#include "twin/separate/curve_covariance.h"

/// Front door of the bench turntable_autocollimator: from readings to the indexing errors of both tables.
namespace twinbench::separate::turntable {

/// What the covariance of a series is the sum of, beside the scatter of the readings.
struct SeriesSources {
  Eigen::VectorXd of_roll_rad;                                  // change with one standard uncertainty of the roll
  std::optional<CurveCovariance> of_teeth_rad2 = std::nullopt;  // of what stated teeth are counted into it
};

/// Values of one table where it was read, by its own angle, ascending in [0, 2 pi); zero mean.
struct AngleSeries {
  std::vector<double> position_rad;
  Eigen::VectorXd value_rad;
  CurveCovariance cov_rad2;
  std::optional<SeriesSources> sources = std::nullopt;  // not given: not known

  double U_rad(Eigen::Index i) const { return std::sqrt(cov_rad2(i, i)); }  // standard uncertainty
};

enum class IndexingStatus {
  kSeparated,      // all but the constants
  kHarmonicsLost,  // some orders are counted as the turntable's
  kSumOnly,        // the shifts separate nothing: `turntable` is turntable plus multi-tooth table
  kUndetermined    // readings are missing so that more is lost than the shifts make it; values NaN
};

struct IndexingOptions {
  int positions = 0;                                        // n; 0: count them
  std::optional<AutocollimatorNoise> noise = std::nullopt;  // not given: from repeats, or else from the residuals
  std::optional<Roll> roll = std::nullopt;                  // not given: estimated
  double u_multitooth_rad = 0.0;  // stated standard uncertainty of a tooth, for what is not separated
};

struct IndexingSeparation {
  IndexingStatus status = IndexingStatus::kUndetermined;
  AngleSeries turntable;   // turntable turned too far: positive
  AngleSeries multitooth;  // without the lost harmonics; each row of teeth has zero mean; empty if kSumOnly
  std::vector<int> lost_harmonics;  // orders a turn; besides the constants
  Roll roll;
  AutocollimatorNoise noise;

  Eigen::VectorXd residual_rad;  // one a stop handed in; NaN if not used
  double residual_rms_rad = kNaN;
  double chi2 = kNaN;  // against the noise; NaN if this came from the residuals
  double dof = kNaN;
  double scale = 1.0;  // on the noise (Birge)
  std::vector<std::string> notes;
};

/// Separates the indexing errors of turntable and multi-tooth table: x = T(position) + R(tooth) + constant of the
/// set-up, after the roll of the crosshair is taken out; least squares over all set-ups and passes, any shifts.
///
/// What no shift separates (lost_harmonics) is counted as the turntable's, so that one shift gives the sum of both,
/// and several rows of teeth its mean over the rows; the multi-tooth table is far better than what it checks. Both
/// tables have zero mean. If the readings exceed the noise (p < 0.001), it is scaled up and a note says so.
///
/// @throws InputError if the angles do not lie on a grid or contradict each other (FindGrid).
///
/// Uncertainty: noise, roll and, for what is not separated, u_multitooth_rad, taken as independent from tooth to
/// tooth. Not included: drift that is the same in all set-ups, flatness of the mirror, errors of the autocollimator
/// other than roll and noise. Reference: docs/theory.md 2; Guo et al. (2014) eq. 1-5.
IndexingSeparation SeparateIndexing(const std::vector<TurntableStop>& stops, const IndexingOptions& options = {});

}  // namespace twinbench::separate::turntable
