#include "twin/benches/hob_transmission/estimators/turn_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/estimators/sample.h"
#include "twin/core/units.h"

namespace twinbench::separate::hob {
namespace {

/// Sums over the samples that the normal equations are made of. Row l of `right` is order l = 0 .. max_order.
struct Sums {
  Eigen::VectorXcd moment;  // [m] = sum exp(j m th), m = 0 .. 2 max_order
  Eigen::MatrixXcd right;   // columns: value, ramp
};

Sums SumUp(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& columns, int max_order) {
  Sums sums{Eigen::VectorXcd::Zero(2 * max_order + 1), Eigen::MatrixXcd::Zero(max_order + 1, columns.cols())};
  for (Eigen::Index i = 0; i < angle_rad.size(); ++i) {
    const Complex step = std::polar(1.0, angle_rad[i]);
    Complex power = 1.0;
    for (int m = 0; m <= 2 * max_order; ++m) {
      sums.moment[m] += power;
      if (m <= max_order) sums.right.row(m) += std::conj(power) * columns.row(i);
      power *= step;
    }
  }
  return sums;
}

/// Rows and columns are the orders -max_order .. max_order.
Eigen::MatrixXcd NormalMatrix(const Eigen::VectorXcd& moment) {
  const Eigen::Index n = moment.size();
  Eigen::MatrixXcd normal(n, n);
  for (Eigen::Index row = 0; row < n; ++row) {
    for (Eigen::Index col = 0; col < n; ++col)
      normal(row, col) = col >= row ? moment[col - row] : std::conj(moment[row - col]);
  }
  return normal;
}

Eigen::MatrixXcd BothSigns(const Eigen::MatrixXcd& right) {
  const Eigen::Index k = right.rows() - 1;
  Eigen::MatrixXcd both(2 * k + 1, right.cols());
  both.bottomRows(k + 1) = right;
  both.topRows(k) = right.bottomRows(k).colwise().reverse().conjugate();
  return both;
}

/// C = 2 z with z the coefficient of exp(+j k th). Of z, `power` is E |z|^2 and `pseudo` E z^2 = E z conj(z of -k).
Eigen::Matrix2d CofactorFrom(double power, Complex pseudo) {
  Eigen::Matrix2d cofactor;
  cofactor << power + pseudo.real(), pseudo.imag(), pseudo.imag(), power - pseudo.real();
  return 2.0 * cofactor;
}

/// @param half  Inverse of the Cholesky factor L: the inverse of the normal matrix is half^H half.
void FillUncertainty(const Eigen::MatrixXcd& half, int max_order, TurnFit& fit) {
  double largest = half.col(max_order).squaredNorm();
  for (int k = 1; k <= max_order; ++k) {
    const auto plus = half.col(max_order + k);
    const auto minus = half.col(max_order - k);
    fit.cofactor.push_back(CofactorFrom(plus.squaredNorm(), plus.dot(minus)));
    largest = std::max(largest, plus.squaredNorm());
  }
  fit.inflation = largest * fit.samples;
}

Eigen::VectorXd Ramp(const Eigen::VectorXd& angle_rad, double middle_rad, int direction) {
  return direction * (angle_rad.array() - middle_rad) / (2.0 * units::kPi);
}

}  // namespace

TurnFit FitTurn(const Eigen::VectorXd& angle_rad, const Eigen::VectorXd& value_rad, double middle_rad,
                int direction, int max_order) {
  TurnFit fit;
  fit.samples = static_cast<int>(angle_rad.size());
  if (fit.samples <= 2 * max_order + 1) return fit;
  // A residual of a mean that is large against the error would be rounding: taken off and put back.
  const double offset_rad = value_rad.mean();
  Eigen::MatrixXd columns(fit.samples, 2);
  columns << value_rad.array() - offset_rad, Ramp(angle_rad, middle_rad, direction);
  const Sums sums = SumUp(angle_rad, columns, max_order);
  const Eigen::LLT<Eigen::MatrixXcd> cholesky(NormalMatrix(sums.moment));
  if (cholesky.info() != Eigen::Success) return fit;
  const Eigen::MatrixXcd right = BothSigns(sums.right);
  const Eigen::MatrixXcd z = cholesky.solve(right);
  const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(right.rows(), right.rows());
  FillUncertainty(cholesky.matrixL().solve(identity), max_order, fit);
  fit.determined = true;
  fit.mean_rad = offset_rad + z(max_order, 0).real();
  fit.value = 2.0 * z.col(0).tail(max_order);
  fit.ramp = 2.0 * z.col(1).tail(max_order);
  fit.residual_sum2 = std::max(0.0, columns.col(0).squaredNorm() - right.col(0).dot(z.col(0)).real());  // rounding
  return fit;
}

Eigen::MatrixXd BesideOrders(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& columns, int max_order) {
  if (angle_rad.size() <= 2 * max_order + 1) return {};
  const Sums sums = SumUp(angle_rad, columns, max_order);
  const Eigen::LLT<Eigen::MatrixXcd> cholesky(NormalMatrix(sums.moment));
  if (cholesky.info() != Eigen::Success) return {};
  const Eigen::MatrixXcd z = cholesky.solve(BothSigns(sums.right));
  Eigen::MatrixXd beside = columns;
  for (Eigen::Index i = 0; i < angle_rad.size(); ++i) {
    const Complex step = std::polar(1.0, angle_rad[i]);
    Complex power = 1.0;
    for (int k = 0; k <= max_order; ++k, power *= step)
      beside.row(i) -= (k == 0 ? 1.0 : 2.0) * (z.row(max_order + k) * power).real();
  }
  return beside;
}

}  // namespace twinbench::separate::hob
