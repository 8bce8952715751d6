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

}  // namespace twinbench::separate::hob
