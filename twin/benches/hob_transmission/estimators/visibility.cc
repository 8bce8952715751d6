#include "twin/benches/hob_transmission/estimators/visibility.h"

#include <cmath>
#include <limits>

namespace twinbench::separate::hob {

constexpr double kRounding = 1e-14;  // of a square of a sum of unit vectors

double NoiseFactor(int order, const std::vector<double>& head_rad) {
  Complex sum = 0.0;
  for (const double head : head_rad) sum += std::polar(1.0, -order * head);
  const auto p = static_cast<double>(head_rad.size());
  const double seen = p * p - std::norm(sum);
  return seen > kRounding * p * p ? std::sqrt(p / seen) : std::numeric_limits<double>::infinity();
}

OrderStatus Judge(double noise_factor, double u_rad, const SeparationLimits& limits) {
  const bool told_apart = noise_factor <= limits.max_noise_factor && u_rad <= limits.max_u_rad;
  return told_apart ? OrderStatus::kSeparated : OrderStatus::kSumOnly;
}

std::vector<VisibleOrder> FindVisibleOrders(const std::vector<double>& head_rad, int max_order,
                                            double u_position_rad, const SeparationLimits& limits) {
  std::vector<VisibleOrder> orders;
  for (int k = 1; k <= max_order; ++k) {
    const double factor = NoiseFactor(k, head_rad);
    const double u_rad = factor * u_position_rad;
    orders.push_back({k, Judge(factor, u_rad, limits), factor, u_rad});
  }
  return orders;
}

}  // namespace twinbench::separate::hob
