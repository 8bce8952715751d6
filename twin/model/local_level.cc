#include "twin/model/local_level.h"

#include <algorithm>

namespace twinbench::model {
namespace {

/// Variance a second of the walk: what the differences scatter beyond the noise of their two ends.
double WalkRate(const Eigen::VectorXd& time_s, const Eigen::VectorXd& shown, double variance) {
  const Eigen::Index steps = shown.size() - 1;
  const double squares = (shown.tail(steps) - shown.head(steps)).squaredNorm();
  const double duration_s = time_s[steps] - time_s[0];
  const double beyond = squares - 2.0 * variance * static_cast<double>(steps);
  // Even a walk that cannot be told from noise may have gone by one reading's noise in all.
  return std::max(beyond, variance) / std::max(duration_s, 1e-9);
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
