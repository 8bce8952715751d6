#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <utility>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/scan_kernels.h"

namespace twinbench::diagnose {

/// What is left of whitened data once the free unknowns have taken their share:
///     W = I - J (J'J + D)^-1 J',   D the prior precisions.
///
/// W is never formed. Local blocks are eliminated by Schur complement; the core is dense. Blocks that the whitening
/// of correlated noise has joined are part of the core.
class Projector {
 public:
  /// @param jacobian  Whitened, rows x unknowns.
  /// @throws std::logic_error if a prior precision is not positive.
  Projector(Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian, const Nuisance& nuisance);

  /// W Y for each column of Y (rows x any).
  Eigen::MatrixXd Apply(const Eigen::MatrixXd& Y) const;

  /// H with S' W S = S'S - H'H (unknowns x columns of S).
  Eigen::MatrixXd Absorbed(const Eigen::MatrixXd& S) const;

  /// The same from J'S.
  Eigen::MatrixXd AbsorbedOf(Eigen::MatrixXd gathered) const { return Forward(std::move(gathered)); }

  /// J'S of an S that is zero but in some rows, which are all that it has here: unknowns x columns of S.
  RunsByRow Gathered(const RunsByRow& S, RowsOf which) const;

  /// Most probable unknowns, (J'J + D)^-1 J' y.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& Y) const;

  /// Rows minus the unknowns that the data determine: the trace of W.
  double DegreesOfFreedom() const { return degrees_of_freedom_; }

  /// Diagonal of W: 1 - leverage, by row.
  Eigen::VectorXd Redundancy() const;
  /// The same of some rows only, in their order.
  Eigen::VectorXd Redundancy(const std::vector<int>& rows) const;

  const Eigen::SparseMatrix<double, Eigen::RowMajor>& Jacobian() const { return jacobian_; }

 private:
  double EliminateLocal(int row, Eigen::Ref<Eigen::VectorXd> core) const;
  Eigen::MatrixXd Forward(Eigen::MatrixXd b) const;   // L^-1 b
  Eigen::MatrixXd Backward(Eigen::MatrixXd h) const;  // L^-T h

  Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian_;
  Eigen::MatrixXd dense_;  // the same where sparse arithmetic would only get in the way; otherwise empty
  int blocks_, size_;
  std::vector<Eigen::MatrixXd> local_;  // Cholesky factors of the blocks
  Eigen::MatrixXd coupling_;            // core x local: B_i L_i^-T side by side
  Eigen::MatrixXd core_;                // Cholesky factor of the Schur complement
  double degrees_of_freedom_ = 0.0;
};

}  // namespace twinbench::diagnose
