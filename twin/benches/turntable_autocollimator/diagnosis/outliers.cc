#include "twin/benches/turntable_autocollimator/diagnosis/outliers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose::turntable {
namespace {

constexpr double kVeryFar = 8.0;  // in robust deviations
constexpr double kLeastRedundancy = 0.05;
constexpr double kSilent = 1e4;

std::string InWords(const NoiseCause& cause) {
  const std::size_t count = cause.outliers.size();
  return fmt::format("{} value{} far outside the noise, left out", count, count == 1 ? "" : "s");
}

/// What is left of every row in units of its axis' scatter, by a robust estimate of it; zero in a sweep, whose few
/// ends alone show what bends.
Eigen::VectorXd Scores(const LinearRun& run, const NoiseModel& noise) {
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Eigen::VectorXd left = projector.Apply(noise.Whiten(run, Eigen::MatrixXd(run.residual))).col(0);
  const Eigen::VectorXd redundancy = projector.Redundancy();
  Eigen::VectorXd z = Eigen::VectorXd::Zero(left.size());
  std::vector<std::vector<double>> sizes(run.channels.size());
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const int row = static_cast<int>(k);
    const auto reading = static_cast<std::size_t>(run.ReadingOf(row));
    if (redundancy[k] < kLeastRedundancy || run.schedule.phase[reading] == Phase::kCalibration) continue;
    z[k] = left[k] / std::sqrt(redundancy[k]);
    sizes[static_cast<std::size_t>(run.ChannelOf(row))].push_back(std::abs(z[k]));
  }
  for (int c = 0; c < run.Channels(); ++c) {
    const auto& of_axis = sizes[static_cast<std::size_t>(c)];
    if (!of_axis.empty()) z(Eigen::seq(c, Eigen::last, run.Channels())) /= std::max(1.0, Median(of_axis) / 0.6745);
  }
  return z;
}

/// Far outside, and the readings before and behind are not.
bool StandsAlone(const LinearRun& run, const Eigen::VectorXd& z, Eigen::Index row) {
  const Eigen::Index step = run.Channels();
  const auto also_far = [&](Eigen::Index other) {
    return other >= 0 && other < z.size() && std::abs(z[other]) > 0.5 * std::abs(z[row]);
  };
  return std::abs(z[row]) > kVeryFar && !also_far(row - step) && !also_far(row + step);
}

}  // namespace

std::optional<NoiseCause> FindOutliers(const LinearRun& run) {
  if (run.noise_free) return std::nullopt;
  NoiseCause cause{NoiseCause::Kind::kOutliers, 0.0, "", {run.sigma, {}}, {}, 0.0};
  const Eigen::Index most = run.Rows() / 20;
  double sum2 = 0.0;
  Eigen::VectorXd found = Eigen::VectorXd::Zero(run.Rows());  // of the rows taken out, as they were
  while (std::ssize(cause.outliers) <= most) {
    const Eigen::VectorXd z = Scores(run, cause.repaired);
    Eigen::Index row = 0;
    z.cwiseAbs().maxCoeff(&row);
    if (!StandsAlone(run, z, row)) break;
    cause.outliers.push_back(static_cast<int>(row));
    found[row] = z[row];
    cause.repaired.sigma[row] *= kSilent;
    sum2 += z[row] * z[row];
    // Each pays for being chosen and for a size that may be anything up to its own.
    cause.log_bayes += 0.5 * z[row] * z[row] - std::log(run.Rows() * 2.0 * std::abs(z[row]));
  }
  if (cause.outliers.empty() || std::ssize(cause.outliers) > most) return std::nullopt;
  if (!StandOut(cause.outliers, (found.array() != 0.0).select(found, Scores(run, cause.repaired))))
    return std::nullopt;
  cause.outlier_size = std::sqrt(sum2 / static_cast<double>(cause.outliers.size()));
  cause.words = InWords(cause);
  return cause;
}

void TakeFurther(Analysis& analysis, NoiseCause& outlying) {
  const auto is_outliers = [](const NoiseCause& c) { return c.kind == NoiseCause::Kind::kOutliers; };
  for (const NoiseCause& further : analysis.repairs) {
    if (!is_outliers(further)) continue;
    const auto n = static_cast<double>(outlying.outliers.size()), m = static_cast<double>(further.outliers.size());
    outlying.outlier_size =
        std::sqrt((n * std::pow(outlying.outlier_size, 2) + m * std::pow(further.outlier_size, 2)) / (n + m));
    outlying.outliers.insert(outlying.outliers.end(), further.outliers.begin(), further.outliers.end());
    outlying.log_bayes += further.log_bayes;
  }
  std::erase_if(analysis.repairs, is_outliers);
  outlying.words = InWords(outlying);
}

double UsualSigma_rad(const LinearRun& run) {
  return Median({run.sigma.begin(), run.sigma.end()});
}

}  // namespace twinbench::diagnose::turntable
