#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/allan.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// Readings in a row: [first, first + count).
struct Stretch {
  int first = 0, count = 0;
};

/// The passes; only the bench at rest if the run has such readings.
std::vector<Stretch> StretchesOf(const Schedule& s) {
  const bool idle = std::ranges::find(s.phase, Phase::kStability) != s.phase.end();
  std::vector<Stretch> stretches;
  for (int i = 0; i < s.Readings(); ++i) {
    if (idle && s.phase[static_cast<std::size_t>(i)] != Phase::kStability) continue;
    const bool goes_on =
        !stretches.empty() && stretches.back().first + stretches.back().count == i && SamePass(s, i, i - 1);
    if (goes_on)
      ++stretches.back().count;
    else
      stretches.push_back({i, 1});
  }
  return stretches;
}

/// Lengths 2, 4, 8, ... of which the longest stretch holds at least four.
std::vector<int> LengthsIn(const std::vector<Stretch>& stretches) {
  int longest = 0;
  for (const Stretch& stretch : stretches) longest = std::max(longest, stretch.count);
  std::vector<int> lengths;
  for (int m = 2; 4 * m <= longest; m *= 2) lengths.push_back(m);
  return lengths;
}

double VarianceOver(const Sample& s, const std::vector<Stretch>& stretches, int channel, int column, int length) {
  AllanVariance variance(length);
  for (const Stretch& stretch : stretches) {
    const int first = stretch.first * s.run.Channels() + channel;
    variance.Add(s.levelled.col(column)(Eigen::seqN(first, stretch.count, s.run.Channels())));
  }
  return variance.Value();
}

/// log(m AVAR(m) / AVAR(1)): about 0 in white noise.
double LogExcess(const Sample& s, const std::vector<Stretch>& stretches, int channel, int column, int length) {
  const double one = VarianceOver(s, stretches, channel, column, 1);
  const double many = length * VarianceOver(s, stretches, channel, column, length);
  return one > 0.0 && many > 0.0 ? std::log(many / one) : 0.0;
}

/// What is there beside white noise, in units of the noise.
double Beyond(const Sample& s, const std::vector<Stretch>& stretches, int channel, int length) {
  const double one = VarianceOver(s, stretches, channel, 0, 1),
               many = VarianceOver(s, stretches, channel, 0, length);
  return std::sqrt(std::max(0.0, many - one / length));
}

}  // namespace

/// Allan deviation of readings in a row: means of more and more of them against what white noise leaves.
Tests TestAveraging(const Sample& s) {
  const LinearRun& run = s.run;
  const std::vector<Stretch> stretches = StretchesOf(run.schedule);
  const std::vector<int> lengths = LengthsIn(stretches);
  const auto count = std::ssize(lengths);
  if (count == 0) return {};
  Eigen::MatrixXd values(count * run.Channels(), s.Columns());
  std::vector<std::string> names;
  for (int k = 0; k < values.rows(); ++k) {
    const int channel = k / static_cast<int>(count), length = lengths[static_cast<std::size_t>(k % count)];
    names.push_back(
        fmt::format("means over {} readings of {}", length, run.channels[static_cast<std::size_t>(channel)]));
    for (int j = 0; j < s.Columns(); ++j) values(k, j) = LogExcess(s, stretches, channel, j, length);
  }
  auto found = TestMoments(values, names, "time: Allan deviation", Sides::kUpper);
  if (!found) return {};
  const int channel = found->item / static_cast<int>(count);
  const double beyond = Beyond(s, stretches, channel, lengths[static_cast<std::size_t>(found->item % count)]);
  SetEffect(run, channel, beyond * s.level[channel] * TypicalSigma(run, channel), found->test);
  found->test.reading =
      fmt::format("{} scatter more than white noise would: flicker, random walk or drift from reading to reading",
                  names[static_cast<std::size_t>(found->item)]);
  return {std::move(found->test)};
}

}  // namespace twinbench::diagnose::screen
