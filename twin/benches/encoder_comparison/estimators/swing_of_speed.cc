#include "twin/benches/encoder_comparison/estimators/swing_of_speed.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>

#include "twin/core/units.h"

namespace twinbench::separate::encoder {
namespace {

using TurnRoots = std::vector<std::complex<double>>;

TurnRoots TurnRootsOf(std::size_t points) {
  TurnRoots roots(points);
  for (std::size_t j = 0; j < points; ++j) roots[j] = std::polar(1.0, units::turn * static_cast<double>(j) / static_cast<double>(points));
  return roots;
}

/// First order of a turn: angle by which the shaft stands beside its course, each order a column.
Eigen::RowVectorXcd FirstOrderOf(const TurnModel& model, Eigen::Index turn, const Eigen::MatrixXcd& by_model) {
  Eigen::RowVectorXcd sum = Eigen::RowVectorXcd::Zero(by_model.cols());
  for (const int column : {model.torque, model.friction})
    if (column >= 0) sum += model.columns(turn, column) * by_model.row(column);
  return sum;
}

/// Its slope all round: the share of the energy that the torque has given.
Eigen::ArrayXd SlopeAlong(const Eigen::RowVectorXcd& order, const TurnRoots& roots) {
  Eigen::ArrayXd slope = Eigen::ArrayXd::Zero(std::ssize(roots));
  for (std::size_t j = 0; j < roots.size(); ++j)
    for (std::size_t k = 1, at = j; k <= static_cast<std::size_t>(order.size()); ++k, at = (at + j) % roots.size()) {
      const std::complex<double> c = order[static_cast<Eigen::Index>(k - 1)];
      slope[static_cast<Eigen::Index>(j)] -= static_cast<double>(k) * (c.real() * roots[at].imag() + c.imag() * roots[at].real());
    }
  return slope;
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

Eigen::MatrixXcd BeyondInverseSquare(const TurnModel& model, const std::vector<CoastTurn>& turns, const Eigen::MatrixXcd& by_model) {
  const Eigen::Index orders = by_model.cols();
  const TurnRoots roots = TurnRootsOf(4 * static_cast<std::size_t>(orders));
  Eigen::MatrixXcd beyond(std::ssize(turns), orders);
  for (Eigen::Index i = 0; i < beyond.rows(); ++i) {
    const Eigen::RowVectorXcd first = FirstOrderOf(model, i, by_model);
    const Eigen::ArrayXd slow = SlownessAlong(SlopeAlong(first, roots));
    Eigen::RowVectorXcd sum = Eigen::RowVectorXcd::Zero(orders);
    for (std::size_t j = 0; j < roots.size(); ++j)
      for (std::size_t k = 1, at = j; k <= static_cast<std::size_t>(orders); ++k, at = (at + j) % roots.size())
        sum[static_cast<Eigen::Index>(k - 1)] += slow[static_cast<Eigen::Index>(j)] * std::conj(roots[at]);
    // Of the time's slope the integral, against the steady course.
    for (Eigen::Index k = 0; k < orders; ++k)
      beyond(i, k) = -2.0 / static_cast<double>(roots.size()) * sum[k] / std::complex<double>(0.0, static_cast<double>(k + 1)) - first[k];
  }
  return beyond;
}

}  // namespace twinbench::separate::encoder
