#include "twin/diagnose/screen/allan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/raw_tests.h"
#include "twin/diagnose/screen/sizes.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

/// Scatter of means against the length that is averaged, of readings and of the samples in raw blocks.
namespace twinbench::diagnose::screen {
namespace {

using Series = std::vector<Eigen::VectorXd>;

/// Lengths 2, 4, 8, ... of which `longest` samples hold at least four.
std::vector<int> LengthsIn(Eigen::Index longest) {
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

/// Readings in a row: [first, first + count).
struct Stretch {
  int first = 0, count = 0;
};

/// The passes; only the bench at rest if the run has such readings.
std::vector<Stretch> StretchesOf(const Schedule& s) {
  const bool idle = std::ranges::find(s.phase, Phase::kStability) != s.phase.end();
  std::vector<Stretch> stretches;
  for (int i = 0; i < s.Readings(); ++i) {
    if (idle && s.phase[i] != Phase::kStability) continue;
    const bool goes_on =
        !stretches.empty() && stretches.back().first + stretches.back().count == i && SamePass(s, i, i - 1);
    if (!goes_on) stretches.push_back({i, 0});
    ++stretches.back().count;
  }
  return stretches;
}

Series SeriesOf(const Sample& s, const std::vector<Stretch>& stretches, int channel, int column) {
  Series series;
  for (const auto& [first, count] : stretches)
    series.emplace_back(
        s.levelled.col(column)(Eigen::seqN(first * s.run.Channels() + channel, count, s.run.Channels())));
  return series;
}

Series SeriesOf(const Eigen::MatrixXd& blocks) {
  return {blocks.colwise().begin(), blocks.colwise().end()};
}

/// Column 0: one channel; the others white noise of the same design, of few blocks with their scatter scaled to as
/// many as there are.
Eigen::MatrixXd WithNulls(const RawSample& s, const Eigen::MatrixXd& blocks, const std::vector<int>& lengths,
                          Stream& stream) {
  constexpr Eigen::Index kMostNullValues = 8192;
  const Eigen::Index few = std::clamp<Eigen::Index>(kMostNullValues / blocks.rows(), 1, blocks.cols());
  Eigen::MatrixXd values(std::ssize(lengths), 1 + s.null_runs);
  values.col(0) = Excess(SeriesOf(blocks), lengths);
  Eigen::MatrixXf white(blocks.rows(), few);
  for (int j = 1; j <= s.null_runs; ++j) {
    stream.FillNormals({white.data(), static_cast<std::size_t>(white.size())});
    values.col(j) = Excess(SeriesOf(white.cast<double>()), lengths);
  }
  auto nulls = values.rightCols(s.null_runs);
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
  return pairs > 0.0 ? 0.5 * sum / pairs : std::numeric_limits<double>::quiet_NaN();
}

void TestAveraging(const Sample& s, Tests& tests) {
  const std::vector<Stretch> stretches = StretchesOf(s.run.schedule);
  int longest = 0;
  for (const Stretch& stretch : stretches) longest = std::max(longest, stretch.count);
  const std::vector<int> lengths = LengthsIn(longest);
  const auto count = static_cast<int>(lengths.size());
  if (count == 0) return;
  Statistic excess{"time: Allan deviation", {}, Eigen::MatrixXd(count * s.run.Channels(), s.Columns())};
  for (int c = 0; c < s.run.Channels(); ++c) {
    for (int j = 0; j < s.Columns(); ++j)
      excess.values.block(c * count, j, count, 1) = Excess(SeriesOf(s, stretches, c, j), lengths);
    for (int m : lengths) excess.items.push_back(ItemOf(excess.test, m, s.run.channels[c]));
  }
  excess.values = excess.values.unaryExpr([](double ratio) { return ratio > 0.0 ? std::log(ratio) : 0.0; });
  const auto meaning = [&, names = excess.items](int item, double, ScreenTest& test) {
    const int channel = item / count;
    const double beyond = Beyond(SeriesOf(s, stretches, channel, 0), lengths[item % count]);
    SetEffect(s.run, channel, beyond * s.Unit_SI(channel), test);
    test.reading = ReadingOf(test.name, names[item]);
  };
  TestMoments(std::move(excess), Sides::kUpper, meaning, tests);
}

/// No logarithm: with few blocks its nulls would not be about 0.
void TestRawAllan(const RawSample& s, Tests& tests) {
  const std::vector<int> lengths = LengthsIn(s.thinned.Samples());
  const auto count = static_cast<int>(lengths.size());
  if (count == 0 || s.thinned.Blocks() == 0) return;
  const std::vector<RawChannel>& channels = s.scale.channels;
  Statistic excess{"raw: Allan deviation", {}, Eigen::MatrixXd(count * std::ssize(channels), 1 + s.null_runs)};
  Stream stream(s.seed, "screen.raw.allan");
  for (int c = 0; c < std::ssize(channels); ++c) {
    excess.values.middleRows(c * count, count) = WithNulls(s, s.thinned.channel[c], lengths, stream);
    for (int m : lengths)
      excess.items.push_back(ItemOf(excess.test, 1e3 * m / s.thinned.rate_Hz, channels[c].name));
  }
  const auto meaning = [&, names = excess.items](int item, double, ScreenTest& test) {
    const int channel = item / count;
    SetEffect(channels[channel], Beyond(SeriesOf(s.thinned.channel[channel]), lengths[item % count]), test);
    test.reading = ReadingOf(test.name, names[item]);
  };
  TestMoments(std::move(excess), Sides::kUpper, meaning, tests);
}

}  // namespace twinbench::diagnose::screen
