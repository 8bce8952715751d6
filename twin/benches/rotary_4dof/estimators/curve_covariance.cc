#include "twin/benches/rotary_4dof/estimators/curve_covariance.h"

#include <cmath>
#include <utility>

namespace twinbench::separate {

CurveCovariance CurveCovariance::Dense(Eigen::MatrixXd matrix) {
  CurveCovariance covariance;
  covariance.dense_ = std::move(matrix);
  return covariance;
}

CurveCovariance CurveCovariance::Circulant(Eigen::MatrixXd lags, Eigen::Index curves) {
  CurveCovariance covariance;
  covariance.lags_ = std::move(lags);
  covariance.curves_ = curves;
  return covariance;
}

Eigen::Index CurveCovariance::rows() const {
  return curves_ > 0 ? curves_ * lags_.rows() : dense_.rows();
}

double CurveCovariance::operator()(Eigen::Index row, Eigen::Index col) const {
  double value = 0.0;
  if (curves_ > 0) {
    const Eigen::Index n = lags_.rows();
    value = lags_((col % n - row % n + n) % n, row / n * curves_ + col / n);
  } else {
    value = dense_(row, col);
  }
  if (factor_.cols() > 0) value += factor_.row(row).dot(factor_.row(col));
  if (row == col && diagonal_.size() > 0) value += diagonal_[row];
  return value;
}

Eigen::VectorXd CurveCovariance::diagonal() const {
  Eigen::VectorXd variances(rows());
  for (Eigen::Index r = 0; r < rows(); ++r) variances[r] = (*this)(r, r);
  return variances;
}

Eigen::MatrixXd CurveCovariance::ToDense() const {
  Eigen::MatrixXd matrix(rows(), rows());
  for (Eigen::Index c = 0; c < rows(); ++c) {
    for (Eigen::Index r = 0; r < rows(); ++r) matrix(r, c) = (*this)(r, c);
  }
  return matrix;
}

CurveCovariance CurveCovariance::operator*(double factor) const {
  CurveCovariance scaled = *this;
  scaled.dense_ *= factor;
  scaled.lags_ *= factor;
  scaled.factor_ *= std::sqrt(factor);
  scaled.diagonal_ *= factor;
  return scaled;
}

void CurveCovariance::AddProduct(const Eigen::MatrixXd& factor) {
  const Eigen::Index before = factor_.cols();
  factor_.conservativeResize(rows(), before + factor.cols());
  factor_.rightCols(factor.cols()) = factor;
}

void CurveCovariance::AddVariance(Eigen::Index row, double variance) {
  if (diagonal_.size() == 0) diagonal_ = Eigen::VectorXd::Zero(rows());
  diagonal_[row] += variance;
}

}  // namespace twinbench::separate
