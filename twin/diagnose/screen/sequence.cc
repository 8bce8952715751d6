#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/sizes.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

/// Readings in a row: products of neighbours, the running sum.
namespace twinbench::diagnose::screen {
namespace {

/// Products of residuals `lag` readings apart in the same pass and channel, summed; one a column. Their expectation
/// is not zero: a projected white residual is negatively correlated. The nulls carry it.
Eigen::RowVectorXd LagProducts(const Sample& s, int lag, int& pairs) {
  const int channels = s.run.Channels();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(s.Columns());
  pairs = 0;
  for (int i = lag; i < s.run.schedule.Readings(); ++i) {
    if (!SamePass(s.run.schedule, i, i - lag)) continue;
    pairs += channels;
    sum += s.levelled.middleRows(i * channels, channels)
               .cwiseProduct(s.levelled.middleRows((i - lag) * channels, channels))
               .colwise()
               .sum();
  }
  return sum;
}

/// Where a running sum is farthest from zero.
struct Peak {
  double height = 0.0;
  int after = 0;  // readings summed
};

Peak PeakOf(const Sample& s, int channel, int column) {
  Peak peak;
  double sum = 0.0;
  for (int i = 0; i < s.run.schedule.Readings(); ++i) {
    sum += s.levelled(i * s.run.Channels() + channel, column);
    if (std::abs(sum) > std::abs(peak.height)) peak = {sum, i + 1};
  }
  return peak;
}

/// Difference of the means behind and before the peak, in units of the noise.
double Change(const Peak& peak, int readings) {
  const double before = peak.after, behind = readings - peak.after;
  return behind > 0.0 ? -peak.height * (1.0 / before + 1.0 / behind) : 0.0;
}

}  // namespace

void TestWhiteness(const Sample& s, Tests& tests) {
  constexpr int kLags = 5;
  Statistic products{"whiteness within a pass", {}, Eigen::MatrixXd(kLags, s.Columns())};
  std::vector<int> pairs(kLags);
  for (int k = 0; k < kLags; ++k) {
    products.values.row(k) = LagProducts(s, k + 1, pairs[k]);
    products.items.push_back(ItemOf(products.test, k + 1));
  }
  const auto meaning = [&](int item, double excess, ScreenTest& test) {
    const double correlation = excess / (s.redundancy.mean() * pairs[item]);
    SetEffect(s.run, AnyChannel(s.run),
              s.level.mean() * TypicalSigma(s.run, 0) * std::sqrt(std::min(1.0, std::abs(correlation))), test);
    test.reading = ReadingBySign(test.name, correlation > 0.0, item + 1, correlation);
  };
  TestMoments(std::move(products), Sides::kBoth, meaning, tests);
}

/// Cumulative sum (Page, Biometrika 41 (1954) 100-115): a mean that shifts or creeps shows as a bend, whatever its
/// course, where a step or a drift would have to have theirs.
void TestCusum(const Sample& s, Tests& tests) {
  const Schedule& schedule = s.run.schedule;
  if (!Varies(schedule.time_s)) return;
  const auto height = [&](Eigen::Index c, Eigen::Index j) {
    return std::abs(PeakOf(s, static_cast<int>(c), static_cast<int>(j)).height);
  };
  const auto meaning = [&](int channel, double, ScreenTest& test) {
    const Peak peak = PeakOf(s, channel, 0);
    const int at = std::min(peak.after, schedule.Readings() - 1);
    SetEffect(s.run, channel, std::abs(Change(peak, schedule.Readings())) * s.Unit_SI(channel), test);
    test.reading = ReadingOf(test.name, s.run.channels[channel], schedule.reading[at], schedule.time_s[at]);
  };
  TestMoments(
      {"time: running sum", s.run.channels, Eigen::MatrixXd::NullaryExpr(s.run.Channels(), s.Columns(), height)},
      Sides::kUpper, meaning, tests);
}

}  // namespace twinbench::diagnose::screen
