#include "twin/core/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace twinbench {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// What Eigen makes of a value that is not finite is undefined, and of no columns at all it reads what is not its own:
/// both stop here.
bool CanBeDecomposed(const MatrixXd& a) {
  return a.size() > 0 && a.allFinite();
}

/// The answer to what cannot be decomposed: NaN, nothing where nothing was asked.
MatrixXd NoNumbers(Eigen::Index rows, Eigen::Index columns) {
  return MatrixXd::Constant(rows, columns, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

RankedSolution SolveRanked(const MatrixXd& a, const MatrixXd& b, double threshold) {
  if (!CanBeDecomposed(a)) return {NoNumbers(a.cols(), b.cols()), 0};
  Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(threshold);
  return {svd.solve(b), svd.rank()};
}

VectorXd SolveShortest(const MatrixXd& a, const VectorXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), 1);
  return a.completeOrthogonalDecomposition().solve(b);
}

MatrixXd SolveShortest(const MatrixXd& a, const MatrixXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), b.cols());
  return a.completeOrthogonalDecomposition().solve(b);
}

MatrixXd GeneralInverseOf(const MatrixXd& a) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), a.rows());
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

MatrixXd NullSpaceOf(const MatrixXd& a, double threshold) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), a.cols());
  // Square the matrix up with zero rows, so that V is complete without asking for more.
  MatrixXd square = MatrixXd::Zero(std::max(a.rows(), a.cols()), a.cols());
  square.topRows(a.rows()) = a;
  const Eigen::JacobiSVD<MatrixXd> svd(square, Eigen::ComputeFullV);
  const VectorXd& sigma = svd.singularValues();
  const Eigen::Index rank = (sigma.array() > threshold * sigma[0]).count();
  return svd.matrixV().rightCols(a.cols() - rank);
}

MatrixXd OrthonormalBasisOf(const MatrixXd& a, double threshold) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.rows(), a.cols());
  Eigen::ColPivHouseholderQR<MatrixXd> qr(a);
  qr.setThreshold(threshold);
  return qr.householderQ() * MatrixXd::Identity(a.rows(), qr.rank());
}

MatrixXd OrthonormalColumnsOf(const MatrixXd& a) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.rows(), a.cols());
  return a.householderQr().householderQ() * MatrixXd::Identity(a.rows(), a.cols());
}

MatrixXd SolveLeastSquares(const MatrixXd& a, const MatrixXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), b.cols());
  return a.colPivHouseholderQr().solve(b);
}

std::optional<Eigen::Vector3d> SolveThree(const Eigen::MatrixX3d& a, const VectorXd& b) {
  if (a.rows() == 0 || !a.allFinite()) return std::nullopt;
  const auto qr = a.colPivHouseholderQr();
  if (qr.rank() < 3) return std::nullopt;
  return qr.solve(b);
}

MatrixXd PseudoInverseOf(const MatrixXd& a) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), a.rows());
  const Eigen::HouseholderQR<MatrixXd> qr(a);
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(a.rows(), a.cols());  // its first columns: rows x columns^2, not rows^2
  return qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>().solve(q.transpose());
}

VectorXd RotatedByQ(const MatrixXd& a, const VectorXd& v) {
  if (a.size() > 0 && !a.allFinite()) return NoNumbers(v.size(), 1);
  return a.householderQr().householderQ().transpose() * v;
}

MatrixXd SolveSquare(const MatrixXd& a, const MatrixXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), b.cols());
  return a.partialPivLu().solve(b);
}

Eigen::Vector4d SolveFour(const Eigen::Matrix4d& a, const Eigen::Vector4d& b) {
  return a.partialPivLu().solve(b);
}

VectorXd SolveSymmetric(const MatrixXd& a, const VectorXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), 1);
  return a.ldlt().solve(b);
}

MatrixXd SolveSymmetric(const MatrixXd& a, const MatrixXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), b.cols());
  return a.ldlt().solve(b);
}

MatrixXd InverseOfSymmetric(const MatrixXd& a) {
  return SolveSymmetric(a, MatrixXd(MatrixXd::Identity(a.rows(), a.rows())));
}

VectorXd SolvePositive(const MatrixXd& a, const VectorXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), 1);
  return a.llt().solve(b);
}

MatrixXd SolvePositive(const MatrixXd& a, const MatrixXd& b) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.cols(), b.cols());
  return a.llt().solve(b);
}

MatrixXd CholeskyFactorOf(const MatrixXd& a) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.rows(), a.rows());
  return a.llt().matrixL();
}

std::optional<MatrixXd> InverseOfPositive(const MatrixXd& a, double least_condition) {
  if (!a.allFinite()) return std::nullopt;
  const Eigen::LLT<MatrixXd> llt(a);
  if (llt.info() != Eigen::Success || !(llt.rcond() > least_condition)) return std::nullopt;
  return llt.solve(MatrixXd::Identity(a.rows(), a.rows()));
}

std::optional<MatrixXd> InverseCholeskyFactor(const MatrixXd& a) {
  if (!a.allFinite()) return std::nullopt;
  const Eigen::LLT<MatrixXd> llt(a);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return llt.matrixL().solve(MatrixXd::Identity(a.rows(), a.rows()));
}

NormalSolution SolveNormal(const MatrixXd& a, const VectorXd& b) {
  if (!CanBeDecomposed(a)) return {NoNumbers(a.rows(), 1), NoNumbers(a.rows(), a.rows())};
  const Eigen::LLT<MatrixXd> llt(a);
  return {llt.solve(b), llt.solve(MatrixXd::Identity(a.rows(), a.rows()))};
}

SymmetricEigen EigenOfSymmetric(const MatrixXd& a) {
  if (!CanBeDecomposed(a)) return {NoNumbers(a.rows(), 1), NoNumbers(a.rows(), a.rows())};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(a);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

VectorXd EigenvaluesOfSymmetric(const MatrixXd& a) {
  if (!CanBeDecomposed(a)) return NoNumbers(a.rows(), 1);
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

MatrixXd CovarianceRootOf(const MatrixXd& cov) {
  const VectorXd u = cov.diagonal().cwiseSqrt();
  const VectorXd unit = u.unaryExpr([](double one) { return one > 0.0 ? 1.0 / one : 0.0; });
  const auto [values, vectors] = EigenOfSymmetric(unit.asDiagonal() * cov * unit.asDiagonal());
  return u.asDiagonal() * vectors * values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace twinbench
