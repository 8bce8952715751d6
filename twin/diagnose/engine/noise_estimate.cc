#include "twin/diagnose/engine/noise_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "twin/core/robust_scale.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

constexpr std::size_t kFewestDifferences = 8;  // differences; fewer say nothing

/// A standard deviation and the number of differences that it was taken from.
struct Scatter {
  double sd = std::numeric_limits<double>::infinity();
  double count = 0.0;

  double RelativeUncertainty() const { return 1.0 / std::sqrt(count); }  // neighbouring differences share readings
};

double RootMeanSquare(const std::vector<double>& values, double most, std::size_t& kept) {
  double square = 0.0;
  kept = 0;
  for (const double v : values) {
    if (std::abs(v) > most) continue;
    square += v * v;
    ++kept;
  }
  return std::sqrt(square / static_cast<double>(kept));
}

/// Begins with the median of absolute values, which outliers hardly move, and goes on to the rms of what lies
/// within three deviations, which uses nearly all that the values can say. The plain rms where the median is zero
/// because the readings have coarse steps.
Scatter SpreadOf(const std::vector<double>& values) {
  if (values.size() < kFewestDifferences) return {};
  constexpr double kWithin3 = 0.98658;  // deviation of a normal distribution within three deviations
  std::size_t kept = 0;
  double sd = RobustDeviation(values);
  if (sd == 0.0)
    return {RootMeanSquare(values, std::numeric_limits<double>::infinity(), kept),
            static_cast<double>(values.size())};
  for (int round = 0; round < 3; ++round) sd = RootMeanSquare(values, 3.0 * sd, kept) / kWithin3;
  return {sd, static_cast<double>(kept)};
}

/// Both together where they agree within three standard uncertainties, the smaller one where they do not.
double SmallerOrMean(const Scatter& a, const Scatter& b) {
  if (a.count == 0.0 || b.count == 0.0) return std::min(a.sd, b.sd);
  const double u = std::hypot(a.RelativeUncertainty(), b.RelativeUncertainty());
  if (std::abs(std::log(a.sd / b.sd)) > 3.0 * u) return std::min(a.sd, b.sd);
  return std::sqrt((a.count * a.sd * a.sd + b.count * b.sd * b.sd) / (a.count + b.count));
}

Scatter FromNeighbours(const Schedule& s, const Eigen::VectorXd& y, const Eigen::VectorXd& variance) {
  std::vector<double> second;
  for (int i = 2; i < s.Readings(); ++i) {
    const bool together = s.pass[i] == s.pass[i - 2] && s.setup[i] == s.setup[i - 2];
    if (!together) continue;
    const double sum = variance[i] + 4.0 * variance[i - 1] + variance[i - 2];
    second.push_back((y[i] - 2.0 * y[i - 1] + y[i - 2]) / std::sqrt(sum));
  }
  return SpreadOf(second);
}

/// Readings of one set-up and direction whose angles differ by no more than `same_rad` are at one stop.
std::vector<int> StopsOf(const Schedule& s, double same_rad) {
  std::vector<int> order(s.Readings()), stop(s.Readings());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int i) { return std::tuple(s.setup[i], s.direction[i], s.reference_rad[i]); });
  int begin = order.empty() ? 0 : order.front(), number = 0;
  for (const int i : order) {
    const bool is_here = s.setup[i] == s.setup[begin] && s.direction[i] == s.direction[begin] &&
                         s.reference_rad[i] - s.reference_rad[begin] <= same_rad;
    if (!is_here) begin = i, ++number;
    stop[i] = number;
  }
  return stop;
}

Scatter FromRepeats(const Schedule& s, const std::vector<int>& stop, const Eigen::VectorXd& y, const Eigen::VectorXd& variance) {
  std::map<int, int> seen;
  std::vector<int> first(s.Readings(), -1);  // of the pass before that took the same stop
  for (int i = 0; i < s.Readings(); ++i) {
    const auto [found, is_new] = seen.try_emplace(stop[i], i);
    if (!is_new && s.pass[found->second] != s.pass[i]) first[i] = found->second;
  }
  std::vector<double> differences;
  for (int i = 1; i < s.Readings(); ++i) {
    const int a = first[i - 1], b = first[i];
    if (a < 0 || b < 0 || a == b || s.pass[i] != s.pass[i - 1]) continue;
    const double sum = variance[i] + variance[b] + variance[i - 1] + variance[a];
    differences.push_back((y[i] - y[b] - (y[i - 1] - y[a])) / std::sqrt(sum));
  }
  return SpreadOf(differences);
}

/// Where no pass goes from stop to stop: what is not the same at a stop that was reached in one direction again.
Scatter AtOneStop(const std::vector<int>& stop, const Eigen::VectorXd& y, const Eigen::VectorXd& variance) {
  std::map<int, std::vector<int>> at;
  for (int i = 0; i < std::ssize(stop); ++i) at[stop[i]].push_back(i);
  double squares = 0.0, count = 0.0;
  for (const auto& [number, readings] : at) {
    double weights = 0.0, mean = 0.0;
    for (const int i : readings) weights += 1.0 / variance[i];
    for (const int i : readings) mean += y[i] / variance[i] / weights;
    for (const int i : readings) squares += std::pow(y[i] - mean, 2) / variance[i];
    count += static_cast<double>(readings.size()) - 1.0;
  }
  if (count < kFewestDifferences) return {};
  return {std::sqrt(squares / count), count};
}

/// Targets in any order: what each reading has beside the straight line between its neighbours on the axis, of those
/// that were reached in its direction or of all.
Scatter OnAxis(const Schedule& s, const Eigen::VectorXd& y, const Eigen::VectorXd& variance, bool by_direction) {
  const auto line = [&](int i) { return std::pair(s.setup[i], by_direction ? s.direction[i] : 0); };
  std::vector<int> order(s.Readings());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int i) { return std::pair(line(i), s.reference_rad[i]); });
  std::vector<double> beside;
  for (std::size_t k = 2; k < order.size(); ++k) {
    const int before = order[k - 2], i = order[k - 1], behind = order[k];
    if (line(before) != line(behind)) continue;
    const double way_rad = s.reference_rad[behind] - s.reference_rad[before];
    const double share = way_rad > 0.0 ? (s.reference_rad[i] - s.reference_rad[before]) / way_rad : 0.5;
    const double sum = variance[i] + std::pow(1.0 - share, 2) * variance[before] + std::pow(share, 2) * variance[behind];
    beside.push_back((y[i] - std::lerp(y[before], y[behind], share)) / std::sqrt(sum));
  }
  return SpreadOf(beside);
}

/// The axis goes to and fro so often that neighbours in time are not neighbours on it.
bool IsInAnyOrder(const Schedule& s) {
  constexpr int kShort = 5;  // readings of a pass
  const std::set<int> passes(s.pass.begin(), s.pass.end());
  return s.Readings() < kShort * static_cast<int>(std::ssize(passes));
}

}  // namespace

double EstimateNoise_rad(const Schedule& schedule, const Eigen::VectorXd& residual_rad, const Eigen::VectorXd& relative,
                         double same_rad) {
  const Eigen::VectorXd variance =
      relative.size() > 0 ? relative.cwiseAbs2() : Eigen::VectorXd::Ones(residual_rad.size()).eval();
  const std::vector<int> stop = StopsOf(schedule, same_rad);
  double estimate_rad = SmallerOrMean(FromNeighbours(schedule, residual_rad, variance),
                                      FromRepeats(schedule, stop, residual_rad, variance));
  if (!std::isfinite(estimate_rad)) estimate_rad = AtOneStop(stop, residual_rad, variance).sd;
  if (IsInAnyOrder(schedule)) {
    for (const bool by_direction : {true, false})
      estimate_rad = std::min(estimate_rad, OnAxis(schedule, residual_rad, variance, by_direction).sd);
  }
  const double range_rad = residual_rad.maxCoeff() - residual_rad.minCoeff();
  const double least_rad = std::max(1e-9 * range_rad, 1e-15);
  return std::isfinite(estimate_rad) ? std::max(estimate_rad, least_rad) : std::max(range_rad, least_rad);
}

}  // namespace twinbench::diagnose
