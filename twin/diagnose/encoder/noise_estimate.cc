#include "twin/diagnose/encoder/noise_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr std::size_t kFewest = 8;  // differences; fewer say nothing

/// From the median of absolute values, which outliers hardly move; from the mean square where the median is zero
/// because the readings have coarse steps.
double Deviation(std::vector<double> values) {
  if (values.size() < kFewest) return std::numeric_limits<double>::infinity();
  double square = 0.0;
  for (double& v : values) {
    square += v * v / static_cast<double>(values.size());
    v = std::abs(v);
  }
  std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
  const double median = values[values.size() / 2];
  constexpr double kNormal = 1.4826;  // deviation of a normal distribution / its median of absolute values
  return median > 0.0 ? kNormal * median : std::sqrt(square);
}

double FromNeighbours(const Schedule& s, const Eigen::VectorXd& y) {
  std::vector<double> second;
  for (int i = 2; i < s.Readings(); ++i) {
    const bool together = s.pass[i] == s.pass[i - 2] && s.setup[i] == s.setup[i - 2];
    if (together) second.push_back(y[i] - 2.0 * y[i - 1] + y[i - 2]);
  }
  return Deviation(second) / std::sqrt(6.0);
}

/// Set-up, direction, and the stop to a microradian.
using Stop = std::tuple<int, int, long long>;

Stop StopOf(const Schedule& s, int i) {
  return {s.setup[i], s.direction[i], std::llround(s.reference_rad[i] / units::urad)};
}

double FromRepeats(const Schedule& s, const Eigen::VectorXd& y) {
  std::map<Stop, int> seen;
  std::vector<int> first(s.Readings(), -1);  // of the pass before that took the same stop
  for (int i = 0; i < s.Readings(); ++i) {
    const auto [found, is_new] = seen.try_emplace(StopOf(s, i), i);
    if (!is_new && s.pass[found->second] != s.pass[i]) first[i] = found->second;
  }
  std::vector<double> differences;
  for (int i = 1; i < s.Readings(); ++i) {
    const int a = first[i - 1], b = first[i];
    if (a < 0 || b < 0 || a == b || s.pass[i] != s.pass[i - 1]) continue;
    differences.push_back(y[i] - y[b] - (y[i - 1] - y[a]));
  }
  return Deviation(differences) / 2.0;
}

}  // namespace

double EstimateNoise_rad(const Schedule& schedule, const Eigen::VectorXd& residual_rad) {
  const double estimate_rad = std::min(FromNeighbours(schedule, residual_rad), FromRepeats(schedule, residual_rad));
  const double range_rad = residual_rad.maxCoeff() - residual_rad.minCoeff();
  const double least_rad = std::max(1e-9 * range_rad, 1e-15);
  return std::isfinite(estimate_rad) ? std::max(estimate_rad, least_rad) : std::max(range_rad, least_rad);
}

}  // namespace twinbench::diagnose::encoder
