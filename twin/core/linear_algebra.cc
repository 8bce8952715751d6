#include "twin/core/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace twinbench {

using Eigen::MatrixXd, Eigen::VectorXd;

RankedSolution SolveRanked(const MatrixXd& a, const MatrixXd& b, double threshold) {
  Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(threshold);
  return {svd.solve(b), svd.rank()};
}

VectorXd SolveShortest(const MatrixXd& a, const VectorXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

MatrixXd SolveShortest(const MatrixXd& a, const MatrixXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

MatrixXd GeneralInverseOf(const MatrixXd& a) {
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

MatrixXd NullSpaceOf(const MatrixXd& a, double threshold) {
  // Square the matrix up with zero rows, so that V is complete without asking for more.
  MatrixXd square = MatrixXd::Zero(std::max(a.rows(), a.cols()), a.cols());
  square.topRows(a.rows()) = a;
  const Eigen::JacobiSVD<MatrixXd> svd(square, Eigen::ComputeFullV);
  const VectorXd& sigma = svd.singularValues();
  const Eigen::Index rank = (sigma.array() > threshold * sigma[0]).count();
  return svd.matrixV().rightCols(a.cols() - rank);
}

MatrixXd OrthonormalBasisOf(const MatrixXd& a, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(a);
  qr.setThreshold(threshold);
  return qr.householderQ() * MatrixXd::Identity(a.rows(), qr.rank());
}

MatrixXd SolveLeastSquares(const MatrixXd& a, const MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd PseudoInverseOf(const MatrixXd& a) {
  const Eigen::HouseholderQR<MatrixXd> qr(a);
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(a.rows(), a.cols());  // its first columns: rows x columns^2, not rows^2
  return qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>().solve(q.transpose());
}

VectorXd RotatedByQ(const MatrixXd& a, const VectorXd& v) {
  return a.householderQr().householderQ().transpose() * v;
}

MatrixXd SolveSquare(const MatrixXd& a, const MatrixXd& b) {
  return a.partialPivLu().solve(b);
}

std::optional<MatrixXd> InverseOfPositive(const MatrixXd& a, double least_condition) {
  const Eigen::LLT<MatrixXd> llt(a);
  if (llt.info() != Eigen::Success || !(llt.rcond() > least_condition)) return std::nullopt;
  return llt.solve(MatrixXd::Identity(a.rows(), a.rows()));
}

std::optional<MatrixXd> InverseCholeskyFactor(const MatrixXd& a) {
  const Eigen::LLT<MatrixXd> llt(a);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return llt.matrixL().solve(MatrixXd::Identity(a.rows(), a.rows()));
}

NormalSolution SolveNormal(const MatrixXd& a, const VectorXd& b) {
  const Eigen::LLT<MatrixXd> llt(a);
  return {llt.solve(b), llt.solve(MatrixXd::Identity(a.rows(), a.rows()))};
}

SymmetricEigen EigenOfSymmetric(const MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(a);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

VectorXd EigenvaluesOfSymmetric(const MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

MatrixXd CovarianceRootOf(const MatrixXd& cov) {
  const VectorXd u = cov.diagonal().cwiseSqrt();
  const VectorXd unit = u.unaryExpr([](double one) { return one > 0.0 ? 1.0 / one : 0.0; });
  const auto [values, vectors] = EigenOfSymmetric(unit.asDiagonal() * cov * unit.asDiagonal());
  return u.asDiagonal() * vectors * values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace twinbench
