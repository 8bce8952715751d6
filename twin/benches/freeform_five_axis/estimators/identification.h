#pragma once

#include <map>
#include <optional>

#include "twin/benches/freeform_five_axis/estimators/probe_model.h"

namespace twinbench::benches::freeform::estimators {

/// Unknowns that move together without the readings telling.
struct NotSeparable {
  std::map<std::string, double> what;  // um and arcsec by name; the first to be chosen is 1
  std::string why;
};

/// A single value that lies far from where all others of its channel have the machine.
struct LoneValue {
  int reading = 0, channel = 0;  // as in `shown`
  double times = 0.0;            // the scatter of what the fit leaves of the others
};

/// All errors of the machine from the readings, as far as they are in them.
struct Identification {
  int setups = 0;
  Eigen::VectorXd unknowns, u;   // um and arcsec; u: what noise does to the least solution
  std::vector<bool> identified;  // the readings alone decide it
  Eigen::MatrixXd covariance;    // of the same
  Eigen::Index rank = 0;
  Eigen::VectorXd singular_values;  // of unit columns, descending, the largest is 1
  std::vector<NotSeparable> not_separable;
  Eigen::Vector3d residual_rms;  // V, V, px
  Eigen::Vector3d residual_per_u;  // over the noise that weighs the readings
  std::optional<LoneValue> lone;   // the worst
  Eigen::Index dof = 0;
  int rounds = 0;
  bool converged = false;
};

/// Least solution of linear equations jacobian * unknowns = seen, and what can be said of it; rows by their
/// weights.
Identification SolveLinear(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& weights,
                           const Eigen::VectorXd& seen, int setups);

/// Sets what the exact model of the bench leaves of the readings with the unknowns found.
void SetResiduals(const FreeformSettings& bench, const std::vector<PoseRead>& poses, Identification& found);

/// One more than the largest number of a set-up.
int SetupsOf(const std::vector<PoseRead>& poses);

/// Gauss-Newton on the readings over their noise, from an ideal machine. Directions whose singular value is below
/// 3e-4 of the largest are left at minimum norm of the unknowns scaled to unit columns.
/// @param poses  As many set-ups as the largest number among them says.
/// Uncertainty: noise of the readings, first order. Not included: constants of probe and artefact, errors that are
/// no cubics.
Identification Identify(const FreeformSettings& bench, const std::vector<PoseRead>& poses);

}  // namespace twinbench::benches::freeform::estimators
