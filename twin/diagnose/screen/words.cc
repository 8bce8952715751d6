#include "twin/diagnose/screen/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace twinbench::diagnose::screen {
namespace {

constexpr std::size_t kLines = 8;

/// Each channel takes weight[c] times one common set of `width` amplitudes.
Eigen::MatrixXd CommonAmplitude(const Eigen::VectorXd& weight, int width) {
  Eigen::MatrixXd constraint = Eigen::MatrixXd::Zero(weight.size() * width, width);
  for (Eigen::Index c = 0; c < weight.size(); ++c) {
    constraint.middleRows(c * width, width) = weight[c] * Eigen::MatrixXd::Identity(width, width);
  }
  return constraint;
}

/// The channel with the largest amplitude, and that amplitude.
std::pair<int, double> LargestAmplitude(const Fit& fit) {
  std::pair<int, double> largest{0, 0.0};
  for (int c = 0; c * fit.width < fit.amplitude.size(); ++c) {
    const double size = fit.amplitude.segment(c * fit.width, fit.width).norm();
    if (size > largest.second) largest = {c, size};
  }
  return largest;
}

void SetSize(const LinearRun& run, int channel, double size_SI, Place& place) {
  place.effect_m = ReadsAngles(run) ? kNaN : size_SI;
  place.effect_rad = AsAngle(run, channel, size_SI);
}

/// What a place must explain to be named: 3/4 of what exceeds the expectation of noise, and half of all.
double LeastToName(const Fit& fit) {
  return std::max(fit.width + 0.75 * (fit.chi2 - fit.dof), 0.5 * fit.chi2);
}

/// What a pattern of `weight` explains, offered to the best so far. Its size is that of the channel that shows it
/// most; if it is a rotation, its own.
void Offer(const LinearRun& run, const Fit& fit, const Pattern& pattern, const std::string& words, double& best,
           Place& place) {
  const Fit common = fit.Constrained(CommonAmplitude(pattern.weight, fit.width), fit.width);
  if (!(common.chi2 > best)) return;
  best = common.chi2;
  place.words = words;
  Eigen::Index channel = 0;
  const double weight = pattern.weight.cwiseAbs().maxCoeff(&channel);
  SetSize(run, static_cast<int>(channel), weight * common.amplitude.norm(), place);
  if (IsAngle(pattern.name)) place.effect_rad = common.amplitude.norm();
}

std::vector<std::string> Loudest(const Eigen::VectorXd& scores, const std::vector<std::string>& items) {
  std::vector<int> order(items.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return scores[a] > scores[b]; });
  std::vector<std::string> lines;
  for (int i : order) {
    if (lines.size() == kLines || !std::isfinite(scores[i])) break;
    lines.push_back(fmt::format("{}: score {:.1f}", items[static_cast<std::size_t>(i)], scores[i]));
  }
  return lines;
}

std::optional<ScanTest> Described(const Sample& sample, const Eigen::MatrixXd& scores,
                                  const std::function<Fit(int item)>& fit, bool patterns, const ScanWords& words) {
  Eigen::Index best = 0;
  ScanTest result;
  ScreenTest& test = result.test;
  test.name = words.name;
  test.statistic = scores.col(0).maxCoeff(&best);
  if (!std::isfinite(test.statistic)) return std::nullopt;
  test.p = PValue(scores.colwise().maxCoeff().transpose());
  result.item = static_cast<int>(best);
  result.fit = fit(result.item);
  const Place place = PlaceOf(sample.run, result.fit, patterns);
  test.effect_m = place.effect_m;
  test.effect_rad = place.effect_rad;
  test.reading = fmt::format("residual follows {} {}: {}", words.items[static_cast<std::size_t>(best)], place.words,
                             words.causes);
  test.tables = Loudest(scores.col(0), words.items);
  return result;
}

}  // namespace

Place PlaceOf(const LinearRun& run, const Fit& fit, bool patterns) {
  const auto [largest, size] = LargestAmplitude(fit);
  Place place{run.Channels() == 1 ? "on " + run.channels.front() : "on several channels", kNaN, kNaN};
  SetSize(run, largest, size, place);
  if (run.Channels() == 1) return place;
  double best = LeastToName(fit);
  if (patterns) {
    for (const Pattern& p : run.patterns) Offer(run, fit, p, "in " + p.name, best, place);
  }
  for (int c = 0; c < run.Channels(); ++c) {
    const std::string& channel = run.channels[static_cast<std::size_t>(c)];
    Offer(run, fit, {channel, Eigen::VectorXd::Unit(run.Channels(), c)}, "on " + channel, best, place);
  }
  return place;
}

std::optional<ScanTest> TestScan(const Sample& sample, const Scan& scan, const ScanWords& words) {
  return Described(
      sample, Scores(sample, scan), [&](int item) { return FitItem(sample, scan, item); }, scan.shapes.size() == 1,
      words);
}

std::optional<ScanTest> FromScores(const Sample& sample, const Eigen::MatrixXd& scores,
                                   const std::function<Fit(int item)>& fit, const ScanWords& words) {
  return Described(sample, scores, fit, true, words);
}

void Keep(std::optional<ScanTest> found, std::vector<ScreenTest>& tests) {
  if (found) tests.push_back(std::move(found->test));
}

std::optional<MomentTest> TestMoments(const Eigen::MatrixXd& values, const std::vector<std::string>& items,
                                      const std::string& name, Sides sides) {
  Eigen::MatrixXd scores = Standardised(values);
  if (scores.cwiseAbs().maxCoeff() == 0.0) return std::nullopt;
  if (sides == Sides::kBoth) scores = scores.cwiseAbs();
  Eigen::Index best = 0;
  MomentTest result;
  result.test.name = name;
  result.test.statistic = scores.col(0).maxCoeff(&best);
  result.test.p = PValue(scores.colwise().maxCoeff().transpose());
  result.test.tables = Loudest(scores.col(0), items);
  result.item = static_cast<int>(best);
  result.excess = values(best, 0) - values.row(best).tail(values.cols() - 1).mean();
  return result;
}

}  // namespace twinbench::diagnose::screen
