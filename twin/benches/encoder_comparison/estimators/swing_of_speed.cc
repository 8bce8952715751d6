#include "twin/benches/encoder_comparison/estimators/swing_of_speed.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "twin/separate/fourier.h"

namespace twinbench::separate::encoder {
namespace {

/// First order of a turn: angle by which the shaft stands beside its course, each order a column.
Eigen::RowVectorXcd FirstOrderOf(const TurnModel& model, Eigen::Index turn, const Eigen::MatrixXcd& by_model) {
  Eigen::RowVectorXcd sum = Eigen::RowVectorXcd::Zero(by_model.cols());
  for (const int column : {model.torque, model.friction})
    if (column >= 0) sum += model.columns(turn, column) * by_model.row(column);
  return sum;
}

/// Its slope all round: the share of the energy that the torque has given.
Eigen::ArrayXd SlopeAlong(const Eigen::RowVectorXcd& order, const Fourier& turn) {
  Eigen::VectorXcd slope = Eigen::VectorXcd::Zero(turn.n());
  for (Eigen::Index k = 1; k <= order.size(); ++k) slope[k] = std::complex<double>(0.0, static_cast<double>(k)) * order[k - 1];
  return turn.Backward(slope).real();
}

/// Time of each piece of a turn over its mean.
Eigen::ArrayXd SlownessAlong(const Eigen::ArrayXd& slope) {
  constexpr int kOfMeanSpeed = 8;  // between the mean speed, by which turns are known, and that of the mean energy
  constexpr double kNearlyStands = 0.1;
  Eigen::ArrayXd slow = Eigen::ArrayXd::Ones(slope.size());
  double mean = 1.0;
  for (int k = 0; k < kOfMeanSpeed; ++k) {
    slow = (1.0 + 2.0 * slope / (mean * mean)).max(kNearlyStands).rsqrt();
    mean = slow.mean();
  }
  return slow / mean;
}

}  // namespace

double LargestBeyond_rad(const TurnModel& model, const Eigen::MatrixXcd& by_model) {
  constexpr double kSecond = 1.5;
  double largest = 0.0;
  for (const int column : {model.torque, model.friction}) {
    if (column < 0) continue;
    double slope2 = 0.0;
    for (Eigen::Index k = 0; k < by_model.cols(); ++k) slope2 += 0.5 * std::pow(static_cast<double>(k + 1), 2) * std::norm(by_model(column, k));
    largest = std::max(largest, kSecond * slope2 * model.columns.col(column).cwiseAbs2().maxCoeff());
  }
  return largest;
}

Eigen::MatrixXcd BeyondInverseSquare(const TurnModel& model, const Eigen::MatrixXcd& by_model) {
  const Eigen::Index orders = by_model.cols();
  const Fourier turn(static_cast<int>(4 * orders));
  Eigen::MatrixXcd beyond(model.columns.rows(), orders);
  for (Eigen::Index i = 0; i < beyond.rows(); ++i) {
    const Eigen::RowVectorXcd first = FirstOrderOf(model, i, by_model);
    const Eigen::ArrayXd slow = SlownessAlong(SlopeAlong(first, turn));
    const Eigen::VectorXcd sum = turn.Forward(slow.matrix().cast<std::complex<double>>());
    // Of the time's slope the integral, against the steady course.
    for (Eigen::Index k = 1; k <= orders; ++k)
      beyond(i, k - 1) = -2.0 / turn.n() * sum[k] / std::complex<double>(0.0, static_cast<double>(k)) - first[k - 1];
  }
  return beyond;
}

}  // namespace twinbench::separate::encoder
