#include <algorithm>
#include <cmath>
#include <numeric>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/estimators.h"
#include "twin/diagnose/screen/raw_tests.h"
#include "twin/diagnose/screen/tests.h"

/// Readings or samples in a row: their running sum, and the scatter of means against the length that is averaged.
namespace twinbench::diagnose::screen {
namespace {

Eigen::VectorXd RunningSum(const Sample& s, int channel, int column) {
  Eigen::VectorXd sum = s.levelled.col(column)(RowsOf(s.run, channel));
  std::partial_sum(sum.begin(), sum.end(), sum.begin());
  return sum;
}

using Series = std::vector<Eigen::VectorXd>;

/// Lengths 2, 4, 8, ... of which the longest series holds at least four means.
std::vector<int> LengthsIn(const Series& series) {
  Eigen::Index longest = 0;
  for (const Eigen::VectorXd& samples : series) longest = std::max(longest, samples.size());
  std::vector<int> lengths;
  for (int m = 2; 4 * m <= longest; m *= 2) lengths.push_back(m);
  return lengths;
}

/// m AVAR(m) / AVAR(1), one entry a length: about 1 in white noise; 0 where there is nothing to compare.
Eigen::VectorXd Excess(const Series& series, const std::vector<int>& lengths) {
  const double one = AllanVariance(series, 1);
  Eigen::VectorXd excess = Eigen::VectorXd::Zero(std::ssize(lengths));
  for (std::size_t k = 0; k < lengths.size() && one > 0.0; ++k)
    excess[k] = lengths[k] * AllanVariance(series, lengths[k]) / one;
  return excess;
}

/// Deviation that is there beside white noise.
double Beyond(const Series& series, int length) {
  return std::sqrt(std::max(0.0, AllanVariance(series, length) - AllanVariance(series, 1) / length));
}

/// The passes of one channel; only of the bench at rest if the run has such readings.
Series PassesOf(const Sample& s, int channel, int column) {
  const Schedule& schedule = s.run.schedule;
  const bool idle = std::ranges::count(schedule.phase, Phase::kStability) > 0;
  const Eigen::VectorXd values = s.levelled.col(column)(RowsOf(s.run, channel));
  Series passes;
  for (int first = 0, i = 1; i <= schedule.Readings(); ++i) {
    if (i < schedule.Readings() && SamePass(schedule, i, i - 1)) continue;
    if (!idle || schedule.phase[first] == Phase::kStability) passes.emplace_back(values.segment(first, i - first));
    first = i;
  }
  return passes;
}

Series SeriesOf(const Eigen::MatrixXd& blocks) {
  return {blocks.colwise().begin(), blocks.colwise().end()};
}

/// Column 0: one channel; the others white noise of the same design, of few blocks with their scatter scaled to as
/// many as there are.
Eigen::MatrixXd WithNulls(const Eigen::MatrixXd& blocks, const std::vector<int>& lengths, int null_runs,
                          Stream& noise) {
  constexpr Eigen::Index kMostNullValues = 8192;
  const Eigen::Index few = std::clamp<Eigen::Index>(kMostNullValues / blocks.rows(), 1, blocks.cols());
  Eigen::MatrixXd values(std::ssize(lengths), 1 + null_runs);
  values.col(0) = Excess(SeriesOf(blocks), lengths);
  for (int j = 1; j <= null_runs; ++j)
    values.col(j) = Excess(SeriesOf(Normals(noise, blocks.rows(), few)), lengths);
  auto nulls = values.rightCols(null_runs);
  const Eigen::VectorXd mean = nulls.rowwise().mean();
  const double scale = std::sqrt(static_cast<double>(few) / static_cast<double>(blocks.cols()));
  nulls = (scale * (nulls.colwise() - mean)).colwise() + mean;
  return values;
}

}  // namespace

double AllanVariance(const Series& series, int length) {
  double sum = 0.0, pairs = 0.0;
  for (const Eigen::VectorXd& samples : series) {
    const Eigen::Index means = samples.size() / length;
    if (means < 2) continue;
    const Eigen::RowVectorXd mean = samples.head(means * length).reshaped(length, means).colwise().mean();
    sum += (mean.tail(means - 1) - mean.head(means - 1)).squaredNorm();
    pairs += static_cast<double>(means - 1);
  }
  return pairs > 0.0 ? 0.5 * sum / pairs : kNaN;
}

/// Cumulative sum (Page, Biometrika 41 (1954) 100-115): a mean that shifts or creeps shows as a bend, whatever its
/// course, where a step or a drift would have to have theirs.
void TestCusum(const Sample& s, Tests& tests) {
  const Schedule& schedule = s.run.schedule;
  if (!Varies(schedule.time_s)) return;
  Statistic heights{"time: running sum", s.run.channels, Eigen::MatrixXd(s.run.Channels(), s.Columns())};
  for (int c = 0; c < s.run.Channels(); ++c) {
    for (int j = 0; j < s.Columns(); ++j) heights.values(c, j) = RunningSum(s, c, j).cwiseAbs().maxCoeff();
  }
  const auto meaning = [&](int channel, double, ScreenTest& test) {
    int peak = 0;
    const double height = RunningSum(s, channel, 0).cwiseAbs().maxCoeff(&peak);
    const double before = peak + 1.0, behind = schedule.Readings() - before;
    const double change = behind > 0.0 ? height * (1.0 / before + 1.0 / behind) : 0.0;  // of the means
    const int at = std::min(peak + 1, schedule.Readings() - 1);
    SetEffect(s.run, channel, change * s.Unit_SI(channel), test);
    test.reading = ReadingOf(test.name, s.run.channels[channel], schedule.reading[at], schedule.time_s[at]);
  };
  TestMoments(heights, Sides::kUpper, meaning, tests);
}

void TestAveraging(const Sample& s, Tests& tests) {
  const std::vector<int> lengths = LengthsIn(PassesOf(s, 0, 0));
  const auto count = static_cast<int>(lengths.size());
  if (count == 0) return;
  Statistic excess{"time: Allan deviation", {}, Eigen::MatrixXd(count * s.run.Channels(), s.Columns())};
  for (int c = 0; c < s.run.Channels(); ++c) {
    for (int j = 0; j < s.Columns(); ++j)
      excess.values.block(c * count, j, count, 1) = Excess(PassesOf(s, c, j), lengths);
    for (int m : lengths) excess.items.push_back(ItemOf(excess.test, m, s.run.channels[c]));
  }
  excess.values = excess.values.unaryExpr([](double ratio) { return ratio > 0.0 ? std::log(ratio) : 0.0; });
  const auto meaning = [&](int item, double, ScreenTest& test) {
    const int channel = item / count;
    const double beyond = Beyond(PassesOf(s, channel, 0), lengths[item % count]);
    SetEffect(s.run, channel, beyond * s.Unit_SI(channel), test);
    test.reading = ReadingOf(test.name, excess.items[item]);
  };
  TestMoments(excess, Sides::kUpper, meaning, tests);
}

/// No logarithm: with few blocks its nulls would not be about 0.
void TestRawAllan(const RawSample& s, Tests& tests) {
  if (s.thinned.Blocks() == 0) return;
  const std::vector<int> lengths = LengthsIn(SeriesOf(s.thinned.channel.front()));
  const auto count = static_cast<int>(lengths.size());
  if (count == 0) return;
  Statistic excess{"raw: Allan deviation", {}, Eigen::MatrixXd(count * s.Channels(), 1 + s.null_runs)};
  Stream noise(s.seed, "screen.raw.allan");
  for (int c = 0; c < s.Channels(); ++c) {
    excess.values.middleRows(c * count, count) = WithNulls(s.thinned.channel[c], lengths, s.null_runs, noise);
    for (int m : lengths) excess.items.push_back(ItemOf(excess.test, 1e3 * m / s.thinned.rate_Hz, s.Name(c)));
  }
  const auto meaning = [&](int item, double, ScreenTest& test) {
    const int channel = item / count;
    const double beyond = Beyond(SeriesOf(s.thinned.channel[channel]), lengths[item % count]);
    SetEffect(s.scale.channels[channel], beyond, test);
    test.reading = ReadingOf(test.name, excess.items[item]);
  };
  TestMoments(excess, Sides::kUpper, meaning, tests);
}

}  // namespace twinbench::diagnose::screen
