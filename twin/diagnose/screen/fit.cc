#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

double MeanSigma(const LinearRun& run) {
  return std::sqrt(run.sigma.squaredNorm() / run.Rows());
}

void TestStatedNoise(const Sample& s, Tests& tests) {
  const double dof = s.redundancy.sum();
  if (!s.run.sigma_stated || !(dof > 0.0)) return;
  // The logarithm: its nulls are nearly Gaussian, and a residual too small is as telling as one too large.
  const Eigen::MatrixXd values = (s.residual.colwise().squaredNorm() / dof).array().max(1e-300).log().matrix();
  auto found = TestMoments(values, {"all readings"}, "fit to stated noise", Sides::kBoth);
  if (!found) return;
  const double ratio = std::exp(0.5 * values(0, 0));
  SetEffect(s.run, AnyChannel(s.run), MeanSigma(s.run) * std::sqrt(std::abs(ratio * ratio - 1.0)), found->test);
  found->test.reading = fmt::format("residuals are {:.3f} times the stated noise: {}", ratio,
                                    ratio > 1.0 ? "something is not modelled, or the noise figure is too small"
                                                : "the noise figure is too large");
  tests.push_back(std::move(found->test));
}

/// Places and directions that were visited more than once; -1 elsewhere.
std::vector<int> Repeats(const Schedule& schedule) {
  std::vector<std::pair<PlaceKey, int>> keys;
  for (int i = 0; i < schedule.Readings(); ++i) {
    keys.emplace_back(PlaceOfReading(schedule, i), schedule.direction[static_cast<std::size_t>(i)]);
  }
  std::vector<int> group = Numbered(keys), count(group.size(), 0);
  for (int g : group) ++count[static_cast<std::size_t>(g)];
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (schedule.phase[i] == Phase::kCalibration || count[static_cast<std::size_t>(group[i])] < 2) group[i] = -1;
  }
  return group;
}

/// Sum of squares between the groups' means (first) and within the groups (second) of one column.
std::pair<double, double> BetweenAndWithin(const Sample& s, const std::vector<int>& group, int column) {
  const int channels = s.run.Channels();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(channels, static_cast<Eigen::Index>(group.size()));
  Eigen::VectorXd count = Eigen::VectorXd::Zero(sum.cols());
  double all = 0.0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (group[i] < 0) continue;
    const auto values = s.residual.col(column).segment(static_cast<Eigen::Index>(i) * channels, channels);
    sum.col(group[i]) += values;
    count[group[i]] += 1.0;
    all += values.squaredNorm();
  }
  const double between = (sum.colwise().squaredNorm().transpose().array() / count.array().max(1.0)).sum();
  return {between, all - between};
}

/// Lack of fit: what repeats have in common against what they do not. Knows no stated noise.
void TestRepeats(const Sample& s, Tests& tests) {
  const std::vector<int> group = Repeats(s.run.schedule);
  Eigen::MatrixXd values(1, s.Columns());
  for (int j = 0; j < s.Columns(); ++j) {
    const auto [between, within] = BetweenAndWithin(s, group, j);
    if (!(within > 0.0)) return;
    values(0, j) = std::log(std::max(between, 1e-300) / within);
  }
  auto found = TestMoments(values, {"places visited again"}, "fit to repeats", Sides::kUpper);
  if (!found) return;
  const double common = std::max(0.0, std::expm1(found->excess));
  SetEffect(s.run, AnyChannel(s.run), MeanSigma(s.run) * std::sqrt(common), found->test);
  found->test.reading = fmt::format(
      "the part of the residual that comes back at each visit is {:.2f} times what "
      "noise gives (variance): {}",
      1.0 + common, common > 0.0 ? "the model lacks something repeatable" : "no lack of fit");
  tests.push_back(std::move(found->test));
}

}  // namespace

Tests TestFit(const Sample& sample) {
  Tests tests;
  TestStatedNoise(sample, tests);
  TestRepeats(sample, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
