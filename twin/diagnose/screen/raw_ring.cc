#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/sample.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kMostLines = 64;

/// Log ratio of the power in the first half of the blocks to that in the second.
Eigen::VectorXd LogRatio(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  return (first.array().max(1e-300) / second.array().max(1e-300)).log();
}

}  // namespace

/// A vibration that the move has started dies out: at its frequency, the first half of a block holds more power
/// than the second. Frequencies are whole cycles a half block; the decay follows from the ratio.
Tests TestRingDown(const ThinnedBlocks& blocks, const RawScale& scale, int null_runs, std::uint64_t seed) {
  const Eigen::Index half = blocks.Samples() / 2;
  const int lines = static_cast<int>(std::min<Eigen::Index>(kMostLines, half / 4));
  if (lines < 2) return {};
  const double half_s = static_cast<double>(half) / blocks.rate_Hz, count = static_cast<double>(blocks.Blocks());
  std::vector<double> frequency_Hz;
  for (int k = 1; k <= lines; ++k) frequency_Hz.push_back(k / half_s);
  ScreenTest test;
  test.name = "raw: ring-down";
  test.statistic = -1e300;
  for (std::size_t c = 0; c < scale.channels.size(); ++c) {
    const Eigen::VectorXd first = Power(blocks.channel[c], 0, half, frequency_Hz, blocks.rate_Hz);
    const Eigen::VectorXd second = Power(blocks.channel[c], half, half, frequency_Hz, blocks.rate_Hz);
    Eigen::Index at = 0;
    const double ratio = LogRatio(first, second).maxCoeff(&at);
    const std::string words =
        fmt::format("{} at {:.4g} Hz, time constant {:.3g} s", scale.channels[c].name,
                    frequency_Hz[static_cast<std::size_t>(at)], 2.0 * half_s / std::max(ratio, 1e-9));
    test.tables.push_back(words);
    if (!(ratio > test.statistic)) continue;
    test.statistic = ratio;
    const double mean_square = std::max(0.0, first[at] - second[at]) / (count * static_cast<double>(half));
    SetRawEffect(scale.channels[c], std::sqrt(2.0 * mean_square), test);
    test.reading =
        "vibration dies out within the blocks, loudest on " + words + ": dwell too short for a resonance";
  }
  Eigen::VectorXd statistic = Eigen::VectorXd::Constant(1 + null_runs, -1e300);
  statistic[0] = test.statistic;
  Stream stream(seed, "screen.raw.ring");
  for (int j = 1; j <= null_runs; ++j) {
    for (std::size_t k = 0; k < scale.channels.size() * static_cast<std::size_t>(lines); ++k) {
      const double first = stream.ChiSquared(2.0 * count);
      statistic[j] = std::max(statistic[j], std::log(first / stream.ChiSquared(2.0 * count)));
    }
  }
  test.p = PValue(statistic);
  return {std::move(test)};
}

}  // namespace twinbench::diagnose::screen
