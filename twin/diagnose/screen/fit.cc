#include <cmath>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/sizes.h"
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
  Statistic level{"fit to stated noise",
                  {ItemOf("fit to stated noise")},
                  (s.residual.colwise().squaredNorm() / dof).array().max(1e-300).log()};
  const double ratio = std::exp(0.5 * level.values(0, 0));
  const auto meaning = [&](int, double, ScreenTest& test) {
    SetEffect(s.run, AnyChannel(s.run), Beside(MeanSigma(s.run), ratio), test);
    test.reading = ReadingBySign(test.name, ratio > 1.0, ratio);
  };
  TestMoments(std::move(level), Sides::kBoth, meaning, tests);
}

/// Places and directions that were visited more than once; -1 elsewhere.
std::vector<int> Repeats(const Schedule& schedule) {
  std::vector<std::pair<PlaceKey, int>> keys;
  for (int i = 0; i < schedule.Readings(); ++i)
    keys.emplace_back(PlaceOfReading(schedule, i), schedule.direction[i]);
  std::vector<int> group = Numbered(keys), count(group.size(), 0);
  for (int g : group) ++count[g];
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (schedule.phase[i] == Phase::kCalibration || count[group[i]] < 2) group[i] = -1;
  }
  return group;
}

/// Sum of squares between the groups' means (first) and within the groups (second) of one column.
std::pair<double, double> BetweenAndWithin(const Sample& s, const std::vector<int>& group, int column) {
  const auto readings = s.residual.col(column).reshaped(s.run.Channels(), s.run.schedule.Readings());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(readings.rows(), readings.cols());
  Eigen::RowVectorXd count = Eigen::RowVectorXd::Zero(readings.cols());
  double all = 0.0;
  for (Eigen::Index i = 0; i < readings.cols(); ++i) {
    if (group[i] < 0) continue;
    sum.col(group[i]) += readings.col(i);
    count[group[i]] += 1.0;
    all += readings.col(i).squaredNorm();
  }
  const double between = sum.colwise().squaredNorm().cwiseQuotient(count.cwiseMax(1.0)).sum();
  return {between, all - between};
}

/// Lack of fit: what repeats have in common against what they do not. Knows no stated noise.
void TestRepeats(const Sample& s, Tests& tests) {
  const std::vector<int> group = Repeats(s.run.schedule);
  Statistic repeated{"fit to repeats", {ItemOf("fit to repeats")}, Eigen::MatrixXd(1, s.Columns())};
  for (int j = 0; j < s.Columns(); ++j) {
    const auto [between, within] = BetweenAndWithin(s, group, j);
    if (!(within > 0.0)) return;
    repeated.values(0, j) = std::log(std::max(between, 1e-300) / within);
  }
  const auto meaning = [&](int, double excess, ScreenTest& test) {
    const double common = std::max(0.0, std::expm1(excess));
    SetEffect(s.run, AnyChannel(s.run), MeanSigma(s.run) * std::sqrt(common), test);
    test.reading = ReadingBySign(test.name, common > 0.0, 1.0 + common);
  };
  TestMoments(std::move(repeated), Sides::kUpper, meaning, tests);
}

}  // namespace

void TestFit(const Sample& sample, Tests& tests) {
  TestStatedNoise(sample, tests);
  TestRepeats(sample, tests);
}

}  // namespace twinbench::diagnose::screen
