#include "twin/benches/hob_transmission/diagnosis/outliers.h"

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/diagnose/engine/noise_causes.h"

namespace twinbench::diagnose::hob {
namespace {

constexpr double kBelieved = 6.0;  // log Bayes factor
constexpr double kFar = 5.0;       // from either side, in deviations of white noise
constexpr int kBeside = 3;

/// Median of the three samples from `first` on; NaN if they are not all of sample i's pass.
double MedianFrom(const SignalContext& c, const Eigen::VectorXd& y, Eigen::Index i, Eigen::Index first) {
  if (first < 0 || first + kBeside > y.size()) return kNaN;
  const auto& s = c.schedule;
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

Distances DistancesOf(const SignalContext& c, const Eigen::VectorXd& y) {
  Distances d{y, y, y};
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double left = MedianFrom(c, y, i, i - kBeside), right = MedianFrom(c, y, i, i + 1);
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

double RobustDeviation(const Eigen::VectorXd& values) {
  std::vector<double> sizes(values.begin(), values.end());
  for (double& v : sizes) v = std::abs(v);
  return Median(std::move(sizes)) / 0.6745;
}

}  // namespace

Outliers FindOutliers(const SignalContext& c, const Eigen::VectorXd& left_rad) {
  Outliers outliers;
  outliers.of = static_cast<int>(c.Samples());
  const Distances d = DistancesOf(c, left_rad);
  LinearRun samples;
  samples.schedule = c.schedule;
  samples.channels = {kTransmission};
  samples.residual = d.between;
  const NoiseModel noise{Eigen::VectorXd::Ones(c.Samples()), 0.0};
  const double deviation_rad = RobustDeviation(d.between);
  if (!(deviation_rad > 0.0)) return outliers;
  double square = 0.0;
  const Rest rest{d.between / deviation_rad, Eigen::VectorXd::Ones(c.Samples())};
  const auto without = [&](const std::vector<int>& rows) {
    Rest others = rest;  // nothing that is fitted joins them
    others.redundancy(rows).setZero();
    return others;
  };
  for (const NoiseCause& cause : FindNoiseCauses(samples, noise, rest, without)) {
    if (cause.kind != NoiseCause::Kind::kOutliers || cause.log_bayes < kBelieved) continue;
    for (const int i : cause.outliers) {
      if (!StandsAlone(d.before[i], d.behind[i], kFar * deviation_rad)) continue;
      outliers.readings.push_back(c.schedule.reading[static_cast<std::size_t>(i)]);
      square += d.between[i] * d.between[i];
    }
    const auto found = static_cast<double>(outliers.readings.size());
    outliers.log_bayes = cause.log_bayes * found / static_cast<double>(cause.outliers.size());
    outliers.size_rad = std::sqrt(square / std::max(found, 1.0));
  }
  return outliers;
}

}  // namespace twinbench::diagnose::hob
