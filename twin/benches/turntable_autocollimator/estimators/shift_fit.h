#pragma once

#include <Eigen/Core>

#include "twin/benches/turntable_autocollimator/estimators/stops.h"

namespace twinbench::separate::turntable {

/// The least-squares problem value = T(position) + R(tooth) + g(set-up) of a grid of stops, all readings of equal
/// weight, factorised once for any values.
///
/// Where the readings leave a choice, the mean of T is zero, so is that of every row of R, and what no shift tells
/// apart (LostHarmonics) is T's. The unknowns stand in the order [T; R; g].
///
/// Separator solves this together with wobble and radial motion of two stacked tables; here there is one motion,
/// and the multi-tooth table may use teeth between the turntable's steps. Cost: (n + teeth + set-ups)^3.
class ShiftFit {
 public:
  explicit ShiftFit(const StopGrid& grid);

  /// False if readings are missing so that more is lost than the shifts make it; all results are NaN then.
  bool determined() const { return determined_; }
  /// Readings minus rank.
  double dof() const { return dof_; }
  int common_steps() const { return common_steps_; }

  /// Unknowns for one value a grid stop; T and R at places that were not read are NaN.
  Eigen::VectorXd Solve(const Eigen::VectorXd& values) const;
  Eigen::VectorXd Residuals(const Eigen::VectorXd& values) const;
  /// Covariance of the unknowns for readings of unit variance.
  const Eigen::MatrixXd& cofactor() const { return cofactor_; }

 private:
  Eigen::MatrixXd NormalMatrix() const;
  Eigen::MatrixXd Choices() const;
  Eigen::VectorXd Unknowns(const Eigen::VectorXd& values) const;
  Eigen::VectorXd ToUnknowns(const Eigen::VectorXd& values) const;

  StopGrid grid_;
  int common_steps_ = 0;
  int unknowns_ = 0;
  Eigen::VectorXd readings_of_;  // each unknown
  Eigen::MatrixXd inverse_;      // of the normal matrix with the choices
  Eigen::MatrixXd cofactor_;
  double dof_ = kNaN;
  bool determined_ = true;
};

}  // namespace twinbench::separate::turntable
