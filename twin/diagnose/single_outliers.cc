#include "twin/diagnose/single_outliers.h"

#include <algorithm>
#include <cmath>

#include "twin/core/robust_scale.h"
#include "twin/diagnose/engine/noise_causes.h"

namespace twinbench::diagnose {
namespace {

constexpr double kBelieved = 6.0;     // log Bayes factor
constexpr double kFarFromBoth = 5.0;  // from either side, in deviations of white noise
constexpr int kBeside = 3;

/// Median of the three samples from `first` on; NaN if they are not all of sample i's pass.
double MedianFrom(const Schedule& s, const Eigen::VectorXd& y, Eigen::Index i, Eigen::Index first) {
  if (first < 0 || first + kBeside > y.size()) return kNaN;
  std::array<double, kBeside> values{};
  for (Eigen::Index k = 0; k < kBeside; ++k) {
    const auto at = static_cast<std::size_t>(first + k), own = static_cast<std::size_t>(i);
    if (s.pass[at] != s.pass[own] || s.setup[at] != s.setup[own]) return kNaN;
    values[static_cast<std::size_t>(k)] = y[first + k];
  }
  std::ranges::sort(values);
  return values[1];
}

/// Distance of each sample from the level before, behind, and between both.
struct Distances {
  Eigen::VectorXd before, behind, between;
};

Distances DistancesOf(const Schedule& s, const Eigen::VectorXd& y) {
  Distances d{y, y, y};
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double left = MedianFrom(s, y, i, i - kBeside), right = MedianFrom(s, y, i, i + 1);
    d.before[i] = y[i] - left;
    d.behind[i] = y[i] - right;
    d.between[i] = 0.5 * (d.before[i] + d.behind[i]);
    // At the ends of a pass there is one side only, and a slope would look like a distance.
    if (!std::isfinite(d.between[i])) d.before[i] = d.behind[i] = d.between[i] = 0.0;
  }
  return d;
}

/// Far from the level before and from that behind, and by much the same: a sample at a step is far from one of them
/// only, and from the other by noise.
bool StandsAlone(double before, double behind, double far) {
  constexpr double kMuchTheSame = 0.3;
  const auto [less, more] = std::minmax({std::abs(before), std::abs(behind)});
  return before * behind > 0.0 && less > far && less > kMuchTheSame * more;
}

}  // namespace

SingleOutliers FindSingleOutliers(const Schedule& schedule, const std::string& channel,
                                  const Eigen::VectorXd& left) {
  SingleOutliers outliers;
  outliers.of = schedule.Readings();
  const Distances d = DistancesOf(schedule, left);
  const double deviation = RobustDeviation(d.between);
  if (!(deviation > 0.0)) return outliers;
  LinearRun samples;
  samples.schedule = schedule;
  samples.channels = {channel};
  samples.residual = d.between;
  const Eigen::VectorXd alike = Eigen::VectorXd::Ones(left.size());
  const Rest rest{d.between / deviation, alike};
  const auto without = [&](const std::vector<int>& rows) {
    Rest others = rest;  // nothing that is fitted joins them
    others.redundancy(rows).setZero();
    return others;
  };
  double square = 0.0;
  for (const NoiseCause& cause : FindNoiseCauses(samples, {alike, {}}, rest, without)) {
    if (cause.kind != NoiseCause::Kind::kOutliers || cause.log_bayes < kBelieved) continue;
    for (const int i : cause.outliers) {
      if (!StandsAlone(d.before[i], d.behind[i], kFarFromBoth * deviation)) continue;
      outliers.readings.push_back(schedule.reading[static_cast<std::size_t>(i)]);
      square += d.between[i] * d.between[i];
    }
    const auto found = static_cast<double>(outliers.readings.size());
    outliers.log_bayes = cause.log_bayes * found / static_cast<double>(cause.outliers.size());
    outliers.size = std::sqrt(square / std::max(found, 1.0));
  }
  return outliers;
}

}  // namespace twinbench::diagnose
