#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"

#include <cmath>
#include <map>

#include "twin/core/units.h"

namespace twinbench::measure {
namespace {

bool Usable(const Reading& reading) {
  return reading.status == ReadingStatus::kOk && std::isfinite(reading.measured_rad) &&
         std::isfinite(reading.reference_rad);
}

/// The value nearest to `last` that differs from `angle_rad` by whole turns.
double Unwrap(double angle_rad, double last_rad) {
  const double turn_rad = 2.0 * units::kPi;
  return angle_rad - turn_rad * std::round((angle_rad - last_rad) / turn_rad);
}

Eigen::VectorXd WithoutSetUpMeans(const AngleComparison& comparison, const std::vector<Reading>& readings) {
  std::map<int, std::pair<double, int>> sums;
  const auto setup_of = [&](Eigen::Index i) { return readings[comparison.used[i]].setup; };
  for (Eigen::Index i = 0; i < comparison.error_rad.size(); ++i) {
    sums[setup_of(i)].first += comparison.error_rad[i];
    ++sums[setup_of(i)].second;
  }
  Eigen::VectorXd rest_rad = comparison.error_rad;
  for (Eigen::Index i = 0; i < rest_rad.size(); ++i)
    rest_rad[i] -= sums[setup_of(i)].first / sums[setup_of(i)].second;
  return rest_rad;
}

double MeanInDirection(const Eigen::VectorXd& rest_rad, const AngleComparison& comparison,
                       const std::vector<Reading>& readings, int direction) {
  double sum_rad = 0.0;
  int count = 0;
  for (Eigen::Index i = 0; i < rest_rad.size(); ++i) {
    if (readings[comparison.used[i]].direction != direction) continue;
    sum_rad += rest_rad[i];
    ++count;
  }
  return count > 0 ? sum_rad / count : kNaN;
}

}  // namespace

AngleComparison CompareAngles(const std::vector<Reading>& readings) {
  AngleComparison comparison;
  std::vector<double> error_rad;
  std::map<int, double> last_rad;  // by set-up
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Reading& reading = readings[i];
    if (!Usable(reading)) continue;
    double& last = last_rad[reading.setup];
    last = Unwrap(reading.measured_rad - reading.reference_rad, last);
    error_rad.push_back(last);
    comparison.used.push_back(static_cast<int>(i));
  }
  comparison.left_out = static_cast<int>(readings.size() - comparison.used.size());
  comparison.error_rad = Eigen::Map<const Eigen::VectorXd>(error_rad.data(), std::ssize(error_rad));
  if (error_rad.empty()) return comparison;
  const Eigen::VectorXd rest_rad = WithoutSetUpMeans(comparison, readings);
  comparison.rms_rad = std::sqrt(rest_rad.squaredNorm() / static_cast<double>(rest_rad.size()));
  comparison.range_rad = rest_rad.maxCoeff() - rest_rad.minCoeff();
  comparison.mean_forward_rad = MeanInDirection(rest_rad, comparison, readings, 1);
  comparison.mean_backward_rad = MeanInDirection(rest_rad, comparison, readings, -1);
  return comparison;
}

}  // namespace twinbench::measure
