#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose {

/// The signatures of all accepted causes side by side.
struct Columns {
  Eigen::MatrixXd S;                // rows x amplitudes, SI, not whitened
  Eigen::VectorXd prior_precision;  // of the amplitudes: 1 / prior_sd^2
};
Columns ColumnsOf(const std::vector<Accepted>& accepted, int rows);

/// Most probable amplitudes beside free unknowns: (S'WS + D)^-1 S'W y.
/// @param S, y  Whitened like the projector's jacobian.
Eigen::VectorXd FitAmplitudes(const Projector& projector, const Eigen::MatrixXd& S, const Eigen::MatrixXd& y,
                              const Eigen::VectorXd& prior_precision);

/// Posterior covariance of these amplitudes for unit noise, in units of their prior deviations: ones on the diagonal
/// where the data say nothing.
Eigen::MatrixXd RelativeCovariance(const Projector& projector, const Eigen::MatrixXd& S,
                                   const Eigen::VectorXd& prior_precision);

/// What the model leaves of the readings, in SI, once the free unknowns have been fitted: without the accepted
/// causes and with them.
struct LeftOver {
  Eigen::VectorXd before, after;
  Eigen::VectorXd unknowns_before, unknowns_after;
};
LeftOver FitAll(const LinearRun& run, const NoiseModel& noise, const std::vector<Accepted>& accepted);

}  // namespace twinbench::diagnose
