#pragma once

#include <Eigen/Core>

namespace twinbench::separate {

/// Covariance of several curves over the same n positions, row s * n + i being curve s at position i.
///
/// Dense, or as small as a full circle leaves it: where all positions are alike, curves covary by how many
/// positions lie between two values (curves^2 x n numbers). Something of low rank and something on the diagonal may
/// be added.
class CurveCovariance {
 public:
  CurveCovariance() = default;
  static CurveCovariance Dense(Eigen::MatrixXd matrix);
  /// @param lags  n x curves^2: column p * curves + q is cov(curve p at i, curve q at i + row).
  static CurveCovariance Circulant(Eigen::MatrixXd lags, Eigen::Index curves);

  Eigen::Index rows() const;
  double operator()(Eigen::Index row, Eigen::Index col) const;
  Eigen::VectorXd diagonal() const;
  Eigen::MatrixXd ToDense() const;
  /// The matrix times columns; n log n a column and curve where it is circulant.
  Eigen::MatrixXd Times(const Eigen::MatrixXd& columns) const;

  /// Sum over positions i, j of cov(curve at i, curve at j) cos(2 pi order (i - j) / n), for the orders 0 to n / 2: n^2 / 2 times the mean variance of both
  /// parts of an order, n^2 times at n / 2. n log n, and n^2 where it is dense.
  /// @param n  Positions.
  Eigen::VectorXd OrderSums(Eigen::Index curve, Eigen::Index n) const;

  CurveCovariance operator*(double factor) const;
  /// Adds one of as many rows; circulant if both are.
  void Add(const CurveCovariance& other);
  /// Adds factor factor^T.
  void AddProduct(const Eigen::MatrixXd& factor);
  /// Takes factor factor^T off.
  void SubtractProduct(const Eigen::MatrixXd& factor);
  void AddVariance(Eigen::Index row, double variance);

 private:
  bool IsCirculant() const { return curves_ > 0; }
  Eigen::MatrixXd TimesCirculant(const Eigen::MatrixXd& columns) const;

  Eigen::MatrixXd dense_;  // or empty, and then
  Eigen::MatrixXd lags_;
  Eigen::Index curves_ = 0;
  Eigen::MatrixXd factor_, taken_;  // rows x rank; no columns if nothing was added or taken off
  Eigen::VectorXd diagonal_;        // beside the others; may be empty
};

}  // namespace twinbench::separate
