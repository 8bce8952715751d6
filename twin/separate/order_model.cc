#include "twin/separate/order_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "twin/core/linear_algebra.h"

namespace twinbench::separate::harmonics {
namespace {

constexpr double kRank = 1e-9;  // singular values below are zero: head angles are known to 1e-15, times order

/// Complex numbers as pairs (re, im).
Eigen::VectorXd Real(const Eigen::VectorXcd& c) {
  Eigen::VectorXd real(2 * c.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) real.segment<2>(2 * i) << c[i].real(), c[i].imag();
  return real;
}

/// Multiplication by complex numbers as 2 x 2 blocks.
Eigen::MatrixXd RealBlocks(const Eigen::MatrixXcd& c) {
  Eigen::MatrixXd real(2 * c.rows(), 2 * c.cols());
  for (Eigen::Index r = 0; r < c.rows(); ++r) {
    for (Eigen::Index col = 0; col < c.cols(); ++col)
      real.block<2, 2>(2 * r, 2 * col) << c(r, col).real(), -c(r, col).imag(), c(r, col).imag(), c(r, col).real();
  }
  return real;
}

Eigen::MatrixXd AllNaN(Eigen::Index n) {
  return Eigen::MatrixXd::Constant(n, n, kNaN);
}

}  // namespace

double SecondOrder(const PositionError& position) {
  double slope2 = 0.0, error2 = 0.0;
  for (int k = 1; k <= position.series.Highest(); ++k) {
    const double power = 0.5 * std::norm(position.series.At(k).value);
    error2 += power;
    slope2 += k * k * power;
  }
  return std::sqrt(slope2 * error2);
}

OrderModel ModelOrder(int order, const Positions& positions, const std::vector<int>& directions,
                      const std::vector<double>& floor_rad) {
  const auto rows = std::ssize(positions);
  const auto psi = std::ssize(directions);
  OrderModel model{Eigen::MatrixXcd::Zero(rows, psi + 1), Eigen::VectorXcd(rows),
                   Eigen::MatrixXd::Zero(2 * rows, 2 * rows)};
  for (Eigen::Index r = 0; r < rows; ++r) {
    const PositionError& position = *positions[static_cast<std::size_t>(r)];
    const double floor = floor_rad[static_cast<std::size_t>(r)];
    const auto direction = std::find(directions.begin(), directions.end(), position.direction);
    model.x(r, direction - directions.begin()) = 1.0;
    model.x(r, psi) = std::polar(1.0, -order * position.head_rad);
    model.reading[r] = position.series.At(order).value;
    model.cov.block<2, 2>(2 * r, 2 * r) =
        position.series.At(order).cov + floor * floor * Eigen::Matrix2d::Identity();
  }
  return model;
}

OrderSolution SolveOrder(const Eigen::MatrixXcd& x, const OrderModel& model) {
  const Eigen::MatrixXd design = RealBlocks(x);
  const Eigen::MatrixXd weight = InverseCholeskyFactor(model.cov).value_or(AllNaN(model.cov.rows()));
  const auto [from_readings, rank] = SolveRanked(weight * design, weight, kRank);
  OrderSolution solution;
  solution.from_readings = from_readings;
  solution.x = solution.from_readings * Real(model.reading);
  solution.chi2 = (weight * (Real(model.reading) - design * solution.x)).squaredNorm();
  solution.dof = static_cast<int>(design.rows() - rank);
  return solution;
}

Eigen::MatrixXd HeadCovariance(int order, const Positions& positions, Complex psi, double u_head_rad) {
  const auto rows = std::ssize(positions);
  std::map<int, Eigen::VectorXcd> moved;  // by set-up
  for (Eigen::Index r = 0; r < rows; ++r) {
    const PositionError& position = *positions[static_cast<std::size_t>(r)];
    Eigen::VectorXcd& m = moved.try_emplace(position.setup, Eigen::VectorXcd::Zero(rows)).first->second;
    m[r] = u_head_rad * order * Complex(0.0, -1.0) * psi * std::polar(1.0, -order * position.head_rad);
  }
  Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(2 * rows, 2 * rows);
  for (const auto& [setup, m] : moved) cov += Real(m) * Real(m).transpose();
  return cov;
}

double NoiseFactorOf(const Eigen::MatrixXcd& x) {
  const auto [inverse, rank] = SolveRanked(RealBlocks(x), Eigen::MatrixXd::Identity(2 * x.rows(), 2 * x.rows()), kRank);
  if (rank < 2 * x.cols()) return std::numeric_limits<double>::infinity();
  return std::sqrt(inverse.topRows(2 * (x.cols() - 1)).rowwise().squaredNorm().maxCoeff());
}

}  // namespace twinbench::separate::harmonics
