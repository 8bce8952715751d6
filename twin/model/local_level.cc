#include "twin/model/local_level.h"

#include <algorithm>
#include <cmath>

namespace twinbench::model {
namespace {

/// Variance a second of the walk: what differences over some readings scatter beyond the noise of their two ends, and
/// beyond what that scatters by itself. What goes slowly shows over many readings alone.
double WalkRate(const Eigen::VectorXd& time_s, const Eigen::VectorXd& shown, double variance) {
  constexpr Eigen::Index kTimes = 8;  // that the run shows the longest differences
  const Eigen::Index n = shown.size();
  const double duration_s = std::max(time_s[n - 1] - time_s[0], 1e-9);
  const double by_chance = 2.0 * std::sqrt(3.0 / static_cast<double>(n));
  // Even a walk that cannot be told from noise may have gone by one reading's noise in all.
  double rate = variance / duration_s;
  for (Eigen::Index lag = 1; lag <= std::max<Eigen::Index>(1, n / kTimes); lag *= 2) {
    const Eigen::Index steps = n - lag;
    const double squares = (shown.tail(steps) - shown.head(steps)).squaredNorm();
    const double passed_s = (time_s.tail(steps) - time_s.head(steps)).sum();
    const double beyond = squares - 2.0 * variance * (1.0 + by_chance) * static_cast<double>(steps);
    if (passed_s > 0.0) rate = std::max(rate, beyond / passed_s);
  }
  return rate;
}

}  // namespace

Eigen::VectorXd Smoothed(const Eigen::VectorXd& time_s, const Eigen::VectorXd& shown, double noise) {
  if (shown.size() < 3 || noise <= 0.0) return shown;
  const double variance = noise * noise, rate = WalkRate(time_s, shown, variance);
  Eigen::VectorXd level(shown.size()), after(shown.size()),
      before(shown.size());  // variances after, before a reading
  level[0] = shown[0];
  after[0] = variance;
  for (Eigen::Index i = 1; i < shown.size(); ++i) {
    before[i] = after[i - 1] + rate * (time_s[i] - time_s[i - 1]);
    const double gain = before[i] / (before[i] + variance);
    level[i] = level[i - 1] + gain * (shown[i] - level[i - 1]);
    after[i] = (1.0 - gain) * before[i];
  }
  for (Eigen::Index i = shown.size() - 2; i >= 0; --i)
    level[i] += after[i] / before[i + 1] * (level[i + 1] - level[i]);
  return level;
}

}  // namespace twinbench::model
