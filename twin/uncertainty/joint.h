#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/uncertainty/budget.h"

/// Results that are uncertain together (JCGM 102, GUM supplement 2): the positions of an error map, the unknowns of a
/// fit.
namespace twinbench::uncertainty {

/// Some quantities by their names, with the covariance that an estimator states of them.
struct Joint {
  std::string name;                // "separation.target"
  std::vector<std::string> names;  // of its quantities: "separation.target.ez_arcsec[3]"
  Eigen::MatrixXd cov;             // in the quantities' units
};

/// Those of the joint's quantities that were determined: that are among `known`, with finite variances.
Joint Determined(const Joint& joint, const std::vector<std::string>& known);

/// The same with what the constants of the scenario add (JCGM 102, 6.2): each source moves all quantities at once,
/// by its sensitivities; second order counts on the diagonal.
Joint Combined(const Joint& joint, const std::vector<Budget>& budgets);

Eigen::MatrixXd CorrelationOf(const Eigen::MatrixXd& cov);

/// A square root that may be multiplied with independent normal numbers: R with R R^T = cov, one column a direction
/// of the space that cov fills. Directions of less than 1e-10 of the largest variance, in units of each quantity's
/// own uncertainty, count as none: lists with their mean taken out have no full rank.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& cov);

/// Smallest region of 95 % of the trials, in two shapes (JCGM 102, 7.7).
struct Region {
  int dimensions = 0;           // rank of the covariance
  double ellipsoid_k = 0.0;     // (y - mean)^T cov^-1 (y - mean) <= k^2; NaN with fewer than ten trials a dimension
  double ellipsoid_gum_k = 0.0;  // the same k of a normal distribution: root of the chi-squared quantile
  double rectangle_k = 0.0;     // |y_i - mean_i| <= k u_i for all i at once
};

/// What trials of some quantities say of them together.
struct JointSpread {
  Joint joint;  // covariance of the trials
  Region region;
};

/// @param trials  One row a trial, one column a quantity of `joint`; all finite.
JointSpread SpreadOfTrials(const Joint& joint, const Eigen::MatrixXd& trials);

}  // namespace twinbench::uncertainty
