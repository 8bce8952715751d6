#include "twin/benches/rotary_4dof/estimators/harmonic_u.h"

#include <algorithm>
#include <cmath>

namespace twinbench::separate {

std::vector<double> HarmonicUncertainties(const TableEstimate& estimate, Component component) {
  const auto n = std::ssize(estimate.value.position_rad);
  const auto at = std::ranges::find(estimate.components, component);
  const bool is_whole = at != estimate.components.end() &&
                        std::ranges::all_of(estimate.u[component], [](double u) { return std::isfinite(u); });
  if (!is_whole) return std::vector<double>(static_cast<std::size_t>(n / 2), kNaN);
  const Eigen::Index curve = at - estimate.components.begin();
  const Eigen::VectorXd sums = estimate.cov.OrderSums(curve, n) + estimate.cov_systematic.OrderSums(curve, n);
  std::vector<double> u;
  for (Eigen::Index k = 1; k <= n / 2; ++k) {
    const double share = (2 * k == n ? 1.0 : 2.0) / static_cast<double>(n);  // of a value in its cosine or sine
    u.push_back(share * std::sqrt(0.5 * sums[k]));
  }
  return u;
}

}  // namespace twinbench::separate
