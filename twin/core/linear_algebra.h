#pragma once

#include <Eigen/Core>
#include <optional>

/// Decompositions of dense real matrices, behind functions: Eigen's are templates that take seconds of every source
/// that names one, so they are compiled here once. They look at numbers, not at units; results are the same bits
/// wherever they are called from.
namespace twinbench {

/// Solution of a least-squares problem that need not determine all unknowns.
struct RankedSolution {
  Eigen::MatrixXd x;  // one column for each of the right-hand sides; the shortest where several are as good
  Eigen::Index rank = 0;
};

/// Least squares by singular values: minimises |a x - b| for each column of b.
/// @param threshold  Singular values below this part of the largest are zero.
RankedSolution SolveRanked(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double threshold);

/// Least squares by a complete orthogonal decomposition: the same, quicker, with rank decided by pivots to rounding.
Eigen::VectorXd SolveShortest(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd SolveShortest(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Moore-Penrose inverse by the same decomposition: it takes b to SolveShortest(a, b).
Eigen::MatrixXd GeneralInverseOf(const Eigen::MatrixXd& a);

/// Orthonormal columns that span the directions x with a x = 0.
/// @param threshold  Singular values up to this part of the largest are zero.
Eigen::MatrixXd NullSpaceOf(const Eigen::MatrixXd& a, double threshold);

/// Orthonormal columns that span what the columns of `a` span.
/// @param threshold  Pivots up to this part of the largest are zero.
Eigen::MatrixXd OrthonormalBasisOf(const Eigen::MatrixXd& a, double threshold);

/// Orthonormal columns, each of the span of the columns of `a` up to it, which has full rank.
Eigen::MatrixXd OrthonormalColumnsOf(const Eigen::MatrixXd& a);

/// Least squares of full rank by pivoted Householder reflections: minimises |a x - b| for each column of b.
Eigen::MatrixXd SolveLeastSquares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Least squares of three unknowns, by the same; nothing if the columns of `a` do not determine them.
std::optional<Eigen::Vector3d> SolveThree(const Eigen::MatrixX3d& a, const Eigen::VectorXd& b);

/// The matrix that takes observations to the least-squares coefficients of the columns of `a`, which has full rank.
Eigen::MatrixXd PseudoInverseOf(const Eigen::MatrixXd& a);

/// Q^T v of a = Q R. Behind its first k entries lies what the first k columns of `a` leave of v.
Eigen::VectorXd RotatedByQ(const Eigen::MatrixXd& a, const Eigen::VectorXd& v);

/// x of a x = b for a square, regular matrix; and for one of four rows.
Eigen::MatrixXd SolveSquare(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::Vector4d SolveFour(const Eigen::Matrix4d& a, const Eigen::Vector4d& b);

/// x of a x = b, and the inverse of `a`, by L D L^T: a symmetric matrix without negative eigenvalues, of which only the lower half is
/// read.
Eigen::VectorXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXd InverseOfSymmetric(const Eigen::MatrixXd& a);

/// x of a x = b for a positive definite matrix, by its Cholesky factor; noise if it is not.
Eigen::VectorXd SolvePositive(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd SolvePositive(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// L of a = L L^T, as far as `a` is positive definite: from the first pivot that is not, what stood there. Only its lower half is read.
Eigen::MatrixXd CholeskyFactorOf(const Eigen::MatrixXd& a);

/// Inverse of a positive definite matrix, of which only the lower half is read.
/// @return nothing if it is not positive definite, or its reciprocal condition is not above the least.
std::optional<Eigen::MatrixXd> InverseOfPositive(const Eigen::MatrixXd& a, double least_condition);

/// Inverse of the Cholesky factor L of a = L L^T, so that a^-1 = L^-T L^-1; nothing if `a` is not positive
/// definite.
std::optional<Eigen::MatrixXd> InverseCholeskyFactor(const Eigen::MatrixXd& a);

/// Solution of positive definite normal equations, and the inverse of their matrix; NaN or noise if it has none.
struct NormalSolution {
  Eigen::VectorXd x;
  Eigen::MatrixXd inverse;
};
NormalSolution SolveNormal(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Eigenvalues of a symmetric matrix in ascending order, and its eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen EigenOfSymmetric(const Eigen::MatrixXd& a);

/// The same without the eigenvectors.
Eigen::VectorXd EigenvaluesOfSymmetric(const Eigen::MatrixXd& a);

/// R with R R^T = cov, for a covariance that may lack rank, may have quantities of any unit and eigenvalues that
/// rounding has left below zero.
Eigen::MatrixXd CovarianceRootOf(const Eigen::MatrixXd& cov);

}  // namespace twinbench
