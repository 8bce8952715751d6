#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"

#include <algorithm>
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

/// Takes whole turns out of one difference after the other. A few readings that are far off (a glitch, a table that
/// was interpolated across the wrap) lead to no other turn: where those behind them are back, they are where they
/// were.
class Continued {
 public:
  double Next(double difference_rad) {
    last_rad_ = Unwrap(difference_rad, last_rad_);
    const double back_rad = Unwrap(difference_rad, level_rad_);
    const bool is_back = std::abs(back_rad - level_rad_) < kNear_rad;
    if (is_back) last_rad_ = back_rad;
    away_ = is_back || is_first_ || away_ == kLongest ? 0 : away_ + 1;
    if (away_ == 0) level_rad_ = last_rad_;
    is_first_ = false;
    return last_rad_;
  }

 private:
  static constexpr double kNear_rad = 0.5 * units::kPi;
  static constexpr int kLongest = 5;  // readings
  double last_rad_ = 0.0, level_rad_ = 0.0;
  int away_ = 0;
  bool is_first_ = true;
};

/// @return the errors less the mean of their set-up, which the comparison has then.
Eigen::VectorXd TakeSetUpMeansOut(const std::vector<Reading>& readings, AngleComparison& comparison) {
  std::map<int, std::pair<double, int>> sums;
  const auto setup_of = [&](Eigen::Index i) { return readings[comparison.used[i]].setup; };
  for (Eigen::Index i = 0; i < comparison.error_rad.size(); ++i) {
    sums[setup_of(i)].first += comparison.error_rad[i];
    ++sums[setup_of(i)].second;
  }
  comparison.mean_rad.resize(std::ssize(sums));
  std::ranges::transform(sums, comparison.mean_rad.begin(), [](const auto& entry) { return entry.second.first / entry.second.second; });
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
  std::map<int, Continued> continued;  // by set-up
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Reading& reading = readings[i];
    if (!Usable(reading)) continue;
    error_rad.push_back(continued[reading.setup].Next(reading.measured_rad - reading.reference_rad));
    comparison.used.push_back(static_cast<int>(i));
  }
  comparison.left_out = static_cast<int>(readings.size() - comparison.used.size());
  comparison.error_rad = Eigen::Map<const Eigen::VectorXd>(error_rad.data(), std::ssize(error_rad));
  if (error_rad.empty()) return comparison;
  const Eigen::VectorXd rest_rad = TakeSetUpMeansOut(readings, comparison);
  comparison.rms_rad = std::sqrt(rest_rad.squaredNorm() / static_cast<double>(rest_rad.size()));
  comparison.range_rad = rest_rad.maxCoeff() - rest_rad.minCoeff();
  comparison.mean_forward_rad = MeanInDirection(rest_rad, comparison, readings, 1);
  comparison.mean_backward_rad = MeanInDirection(rest_rad, comparison, readings, -1);
  return comparison;
}

}  // namespace twinbench::measure
