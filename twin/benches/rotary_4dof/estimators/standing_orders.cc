#include "twin/benches/rotary_4dof/estimators/standing_orders.h"

#include <cmath>
#include <complex>
#include <vector>

#include "twin/core/units.h"
#include "twin/separate/fourier.h"

namespace twinbench::separate::rotary {
namespace {

constexpr double kByChanceInAll = 0.005;

/// Covariance by how many angles lie between, the mean over all pairs.
Eigen::VectorXd LagsOf(const Eigen::MatrixXd& cov) {
  const Eigen::Index n = cov.rows();
  Eigen::VectorXd lags = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) lags[(j - i + n) % n] += cov(i, j) / static_cast<double>(n);
  }
  return lags;
}

struct Order {
  std::complex<double> size;
  double variance = 0.0;  // of `size`, both parts together
  bool is_kept = false;

  double Clearness() const { return std::norm(size) / variance; }
};

std::vector<Order> OrdersOf(const ErrorMotion& motion) {
  const Eigen::Index n = motion.contour.size();
  const Fourier fourier(static_cast<int>(n));
  const Eigen::VectorXcd sizes = fourier.Forward(motion.contour.cast<std::complex<double>>()) / static_cast<double>(n),
                         variances = fourier.Forward(LagsOf(motion.cov).cast<std::complex<double>>()) / static_cast<double>(n);
  std::vector<Order> orders;
  for (Eigen::Index k = 0; 2 * k < n; ++k) orders.push_back({sizes[k], std::max(0.0, variances[k].real()), k < 2});
  const double clear = std::log(static_cast<double>(orders.size()) / kByChanceInAll);
  std::size_t clearest = 2;
  for (std::size_t k = 2; k < orders.size(); ++k) {
    orders[k].is_kept = orders[k].Clearness() > clear;
    if (orders[k].Clearness() > orders[clearest].Clearness()) clearest = k;
  }
  orders[clearest].is_kept = true;
  return orders;
}

}  // namespace

ErrorMotion OfStandingOrders(const ErrorMotion& motion) {
  constexpr Eigen::Index kFewest = 8;
  const Eigen::Index n = motion.contour.size();
  if (motion.cov.size() == 0 || n < kFewest || !(motion.cov.diagonal().minCoeff() > 0.0)) return motion;
  ErrorMotion standing = motion;
  standing.contour.setZero();
  Eigen::VectorXd lags = Eigen::VectorXd::Zero(n);
  const std::vector<Order> orders = OrdersOf(motion);
  for (std::size_t order = 0; order < orders.size(); ++order) {
    if (!orders[order].is_kept) continue;
    const double sides = order == 0 ? 1.0 : 2.0;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double phase =
          units::turn * static_cast<double>((static_cast<Eigen::Index>(order) * k) % n) / static_cast<double>(n);
      standing.contour[k] += sides * (orders[order].size * std::polar(1.0, phase)).real();
      lags[k] += sides * orders[order].variance * std::cos(phase);
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) standing.cov(i, j) = lags[(j - i + n) % n];
    for (double& beside : standing.scatter[static_cast<std::size_t>(i)])
      beside += motion.contour[i] - standing.contour[i];
  }
  return standing;
}

}  // namespace twinbench::separate::rotary
