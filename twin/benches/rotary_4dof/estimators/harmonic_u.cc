#include "twin/benches/rotary_4dof/estimators/harmonic_u.h"

#include <algorithm>
#include <cmath>

namespace twinbench::separate {
namespace {

/// Columns 2 k - 2 and 2 k - 1: what makes cosine and sine of order k of values at the positions.
Eigen::MatrixXd ToHarmonics(const std::vector<double>& position_rad) {
  const auto n = std::ssize(position_rad);
  Eigen::MatrixXd to(n, 2 * (n / 2));
  for (Eigen::Index k = 1; k <= n / 2; ++k) {
    const double share = (2 * k == n ? 1.0 : 2.0) / static_cast<double>(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double angle_rad = static_cast<double>(k) * position_rad[static_cast<std::size_t>(i)];
      to(i, 2 * k - 2) = share * std::cos(angle_rad);
      to(i, 2 * k - 1) = share * std::sin(angle_rad);
    }
  }
  return to;
}

}  // namespace

std::vector<double> HarmonicUncertainties(const TableEstimate& estimate, Component component) {
  const auto n = std::ssize(estimate.value.position_rad);
  const auto at = std::ranges::find(estimate.components, component);
  const bool is_whole = at != estimate.components.end() &&
                        std::ranges::all_of(estimate.u[component], [](double u) { return std::isfinite(u); });
  if (!is_whole) return std::vector<double>(static_cast<std::size_t>(n / 2), kNaN);
  const Eigen::Index first = (at - estimate.components.begin()) * n;
  const Eigen::MatrixXd cov = Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) {
    return estimate.cov(first + i, first + j) + estimate.cov_systematic(first + i, first + j);
  });
  const Eigen::MatrixXd to = ToHarmonics(estimate.value.position_rad);
  const Eigen::VectorXd variance = (to.cwiseProduct(cov * to)).colwise().sum().transpose();
  std::vector<double> u;
  for (Eigen::Index k = 0; k < n / 2; ++k) u.push_back(std::sqrt(0.5 * (variance[2 * k] + variance[2 * k + 1])));
  return u;
}

}  // namespace twinbench::separate
