#pragma once

#include <Eigen/Core>

namespace twinbench::diagnose {

/// Least squares that takes one row after the other and can say at any time what the next should be.
///
/// Keeps the triangular square root R of the information, R'R = J'J + D, and z with R x = z, updated by Givens
/// rotations (Golub & Van Loan, Matrix Computations, 5.1 and 12.5): weak priors and sharp readings stand beside
/// each other without loss of digits. A row costs unknowns^2 at most; entries that are zero cost nothing.
class SequentialFit {
 public:
  /// @param prior_precision  D, one an unknown, all positive; the prior mean is zero.
  explicit SequentialFit(const Eigen::VectorXd& prior_precision);

  /// Takes in a row of unit variance: row * x = value.
  void Absorb(Eigen::VectorXd row, double value);

  /// Most probable unknowns from the rows so far.
  Eigen::VectorXd Solution() const;

  /// Covariance of `rows` * x (few x unknowns).
  Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& rows) const;

 private:
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> root_;  // R, upper triangular
  Eigen::VectorXd right_;                                                        // z
};

}  // namespace twinbench::diagnose
