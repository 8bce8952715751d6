#include "twin/diagnose/sequential_fit.h"

#include <cmath>
#include <utility>

#include "twin/core/errors.h"

namespace twinbench::diagnose {

SequentialFit::SequentialFit(const Eigen::VectorXd& prior_precision)
    : root_(prior_precision.cwiseSqrt().asDiagonal()), right_(Eigen::VectorXd::Zero(prior_precision.size())) {
  Require((prior_precision.array() > 0.0).all(), "every free unknown needs a positive prior precision");
}

void SequentialFit::Absorb(Eigen::VectorXd row, double value) {
  const Eigen::Index n = root_.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    if (row[j] == 0.0) continue;
    const double length = std::hypot(root_(j, j), row[j]);
    const double c = root_(j, j) / length, s = row[j] / length;
    auto kept = root_.row(j).tail(n - j);
    auto rest = row.tail(n - j);
    const Eigen::RowVectorXd turned = c * kept + s * rest.transpose();
    rest = c * rest - s * kept.transpose();
    kept = turned;
    row[j] = 0.0;
    const double turned_right = c * right_[j] + s * value;
    value = c * value - s * right_[j];
    right_[j] = turned_right;
  }
}

Eigen::VectorXd SequentialFit::Solution() const {
  return root_.triangularView<Eigen::Upper>().solve(right_);
}

Eigen::MatrixXd SequentialFit::CovarianceOf(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd half =
      root_.transpose().triangularView<Eigen::Lower>().solve(Eigen::MatrixXd(rows.transpose()));
  return half.transpose() * half;
}

}  // namespace twinbench::diagnose
