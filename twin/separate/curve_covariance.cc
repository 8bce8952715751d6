#include "twin/separate/curve_covariance.h"

#include <cmath>
#include <complex>
#include <utility>

#include "twin/core/errors.h"
#include "twin/separate/fourier.h"

namespace twinbench::separate {
namespace {

void AppendColumns(const Eigen::MatrixXd& columns, Eigen::MatrixXd& matrix) {
  const Eigen::Index before = matrix.cols();
  matrix.conservativeResize(columns.rows(), before + columns.cols());
  matrix.rightCols(columns.cols()) = columns;
}

/// Entry of factor factor^T.
double ProductAt(const Eigen::MatrixXd& factor, Eigen::Index row, Eigen::Index col) {
  return factor.cols() > 0 ? factor.row(row).dot(factor.row(col)) : 0.0;
}

}  // namespace

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
  return IsCirculant() ? curves_ * lags_.rows() : dense_.rows();
}

double CurveCovariance::operator()(Eigen::Index row, Eigen::Index col) const {
  double value = 0.0;
  if (IsCirculant()) {
    const Eigen::Index n = lags_.rows();
    value = lags_((col % n - row % n + n) % n, row / n * curves_ + col / n);
  } else {
    value = dense_(row, col);
  }
  value += ProductAt(factor_, row, col) - ProductAt(taken_, row, col);
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
  scaled.taken_ *= std::sqrt(factor);
  scaled.diagonal_ *= factor;
  return scaled;
}

Eigen::MatrixXd CurveCovariance::Times(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd product = IsCirculant() ? TimesCirculant(columns) : Eigen::MatrixXd(dense_ * columns);
  if (factor_.cols() > 0) product += factor_ * (factor_.transpose() * columns);
  if (taken_.cols() > 0) product -= taken_ * (taken_.transpose() * columns);
  if (diagonal_.size() > 0) product += diagonal_.asDiagonal() * columns;
  return product;
}

/// y_p(i) = sum over q and j of lags_pq(j - i) x_q(j): a product of transforms, that of the lags conjugate.
Eigen::MatrixXd CurveCovariance::TimesCirculant(const Eigen::MatrixXd& columns) const {
  const Eigen::Index n = lags_.rows();
  const Fourier fourier(static_cast<int>(n));
  Eigen::MatrixXcd waves(n, lags_.cols());
  for (Eigen::Index c = 0; c < lags_.cols(); ++c) waves.col(c) = fourier.Forward(lags_.col(c).cast<std::complex<double>>()).conjugate();
  Eigen::MatrixXd product(columns.rows(), columns.cols());
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::MatrixXcd sums = Eigen::MatrixXcd::Zero(n, curves_);
    for (Eigen::Index q = 0; q < curves_; ++q) {
      const Eigen::VectorXcd x = fourier.Forward(columns.col(c).segment(q * n, n).cast<std::complex<double>>());
      for (Eigen::Index p = 0; p < curves_; ++p) sums.col(p) += waves.col(p * curves_ + q).cwiseProduct(x);
    }
    for (Eigen::Index p = 0; p < curves_; ++p)
      product.col(c).segment(p * n, n) = fourier.Backward(sums.col(p)).real() / static_cast<double>(n);
  }
  return product;
}

Eigen::VectorXd CurveCovariance::OrderSums(Eigen::Index curve, Eigen::Index n) const {
  Eigen::VectorXd lags = Eigen::VectorXd::Zero(n);  // sums along the diagonals of the curve's block
  if (IsCirculant()) {
    lags = static_cast<double>(n) * lags_.col(curve * curves_ + curve);
  } else {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) lags[(j - i + n) % n] += dense_(curve * n + i, curve * n + j);
    }
  }
  if (diagonal_.size() > 0) lags[0] += diagonal_.segment(curve * n, n).sum();
  const Fourier fourier(static_cast<int>(n));
  const auto forward = [&](const Eigen::VectorXd& x) { return fourier.Forward(x.cast<std::complex<double>>()); };
  Eigen::VectorXd sums = forward(lags).real();
  for (Eigen::Index c = 0; c < factor_.cols(); ++c) sums += forward(factor_.col(c).segment(curve * n, n)).cwiseAbs2();
  for (Eigen::Index c = 0; c < taken_.cols(); ++c) sums -= forward(taken_.col(c).segment(curve * n, n)).cwiseAbs2();
  return sums.head(n / 2 + 1);
}

void CurveCovariance::Add(const CurveCovariance& other) {
  Require(rows() == other.rows(), "covariances of as many values");
  if (IsCirculant() && other.IsCirculant() && curves_ == other.curves_) {
    lags_ += other.lags_;
    if (other.factor_.cols() > 0) AddProduct(other.factor_);
    if (other.taken_.cols() > 0) SubtractProduct(other.taken_);
    for (Eigen::Index r = 0; r < other.diagonal_.size(); ++r) AddVariance(r, other.diagonal_[r]);
  } else {
    *this = Dense(ToDense() + other.ToDense());
  }
}

void CurveCovariance::AddProduct(const Eigen::MatrixXd& factor) {
  Require(factor.rows() == rows(), "one row a value");
  AppendColumns(factor, factor_);
}

void CurveCovariance::SubtractProduct(const Eigen::MatrixXd& factor) {
  Require(factor.rows() == rows(), "one row a value");
  AppendColumns(factor, taken_);
}

void CurveCovariance::AddVariance(Eigen::Index row, double variance) {
  if (diagonal_.size() == 0) diagonal_ = Eigen::VectorXd::Zero(rows());
  diagonal_[row] += variance;
}

}  // namespace twinbench::separate
