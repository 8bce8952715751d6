#include "twin/diagnose/screen/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

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

bool IsAngle(const std::string& pattern) {
  return pattern == "yaw" || pattern == "tilt" || pattern == "roll";
}

double LargestAmplitude(const Fit& fit) {
  double largest = 0.0;
  for (Eigen::Index c = 0; c * fit.width < fit.amplitude.size(); ++c) {
    largest = std::max(largest, fit.amplitude.segment(c * fit.width, fit.width).norm());
  }
  return largest;
}

/// What a place must explain to be named: 3/4 of what exceeds the expectation of noise, and half of all.
double LeastToName(const Fit& fit) {
  return std::max(fit.width + 0.75 * (fit.chi2 - fit.dof), 0.5 * fit.chi2);
}

/// What a pattern of `weight` explains, offered to the best so far.
void Offer(const Fit& fit, const Eigen::VectorXd& weight, const std::string& words, bool angle, double& best,
           Place& place) {
  const Fit common = fit.Constrained(CommonAmplitude(weight, fit.width), fit.width);
  if (!(common.chi2 > best)) return;
  best = common.chi2;
  place.words = words;
  place.effect_m = weight.cwiseAbs().maxCoeff() * common.amplitude.norm();
  place.effect_rad = angle ? common.amplitude.norm() : kNaN;
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

}  // namespace

Place PlaceOf(const LinearRun& run, const Fit& fit, bool patterns) {
  if (run.Channels() == 1) {
    const double size = fit.amplitude.norm();
    return {"on " + run.channels.front(), size, ReadsAngles(run) ? size : kNaN};
  }
  double best = LeastToName(fit);
  Place place{"on several channels", LargestAmplitude(fit), kNaN};
  if (patterns) {
    for (const Pattern& p : run.patterns) Offer(fit, p.weight, "in " + p.name, IsAngle(p.name), best, place);
  }
  for (int c = 0; c < run.Channels(); ++c) {
    const std::string& channel = run.channels[static_cast<std::size_t>(c)];
    Offer(fit, Eigen::VectorXd::Unit(run.Channels(), c), "on " + channel, ReadsAngles(run), best, place);
  }
  return place;
}

std::optional<ScanTest> TestScan(const Sample& sample, const Scan& scan, const ScanWords& words) {
  const Eigen::MatrixXd scores = Scores(sample, scan);
  Eigen::Index best = 0;
  ScanTest result;
  ScreenTest& test = result.test;
  test.name = words.name;
  test.statistic = scores.col(0).maxCoeff(&best);
  if (!std::isfinite(test.statistic)) return std::nullopt;
  test.p = PValue(scores.colwise().maxCoeff().transpose());
  result.item = static_cast<int>(best);
  result.fit = FitItem(sample, scan, result.item);
  const Place place = PlaceOf(sample.run, result.fit, scan.shapes.size() == 1);
  test.effect_m = place.effect_m;
  test.effect_rad = place.effect_rad;
  test.reading = fmt::format("residual follows {} {}: {}", words.items[static_cast<std::size_t>(best)], place.words,
                             words.causes);
  test.tables = Loudest(scores.col(0), words.items);
  return result;
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

std::string Amount(const LinearRun& run, double value_SI) {
  return fmt::format("{:.3g} {}", value_SI / run.to_SI, run.unit);
}

bool ReadsAngles(const LinearRun& run) {
  return run.unit == "arcsec" || run.unit == "deg" || run.unit == "rad";
}

void SetEffect(const LinearRun& run, double size_SI, ScreenTest& test) {
  test.effect_m = size_SI;
  if (ReadsAngles(run)) test.effect_rad = size_SI;
}

double TypicalSigma(const LinearRun& run, int channel) {
  double squared = 0.0;
  for (int k = channel; k < run.Rows(); k += run.Channels()) squared += run.sigma[k] * run.sigma[k];
  return std::sqrt(squared * run.Channels() / run.Rows());
}

}  // namespace twinbench::diagnose::screen
