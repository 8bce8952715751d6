#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/sample.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kNeighbours = 6;

/// Frequencies that the blocks hold at least once and below the middle of the band.
std::vector<double> MainsIn(const ThinnedBlocks& blocks) {
  std::vector<double> mains_hz;
  for (double f : {50.0, 60.0, 100.0, 120.0}) {
    if (f * blocks.Duration_s() >= 1.0 - 1e-9 && f < 0.25 * blocks.rate_hz) mains_hz.push_back(f);
  }
  return mains_hz;
}

/// The floor beside a line: whole cycles a block above it, the next one left out.
std::vector<double> Neighbours(double mains_hz, const ThinnedBlocks& blocks) {
  std::vector<double> beside_hz;
  for (int k = 2; k < 2 + kNeighbours; ++k) beside_hz.push_back(mains_hz + k / blocks.Duration_s());
  return beside_hz;
}

struct Line {
  std::string name;
  double log_ratio = kNaN;  // of its power to the floor's
  double amplitude = kNaN;  // codes
};

Line LineAt(const ThinnedBlocks& blocks, int channel, double mains_hz, const std::string& name) {
  const Eigen::MatrixXd& samples = blocks.channel[static_cast<std::size_t>(channel)];
  const double line = Power(samples, 0, samples.rows(), {mains_hz}, blocks.rate_hz)[0];
  const double floor = Power(samples, 0, samples.rows(), Neighbours(mains_hz, blocks), blocks.rate_hz).mean();
  const double each = std::max(0.0, line - floor) / static_cast<double>(samples.size());
  return {fmt::format("{:.0f} Hz on {}", mains_hz, name),
          std::log(std::max(line, 1e-300) / std::max(floor, 1e-300)), std::sqrt(2.0 * each)};
}

/// Largest log ratio of `lines` lines and floors of white noise.
double NullMaximum(Stream& stream, std::size_t lines, double blocks) {
  double largest = -1e300;
  for (std::size_t k = 0; k < lines; ++k) {
    const double floor = stream.ChiSquared(2.0 * blocks * kNeighbours) / kNeighbours;
    largest = std::max(largest, std::log(stream.ChiSquared(2.0 * blocks) / floor));
  }
  return largest;
}

}  // namespace

Tests TestHum(const ThinnedBlocks& blocks, const RawScale& scale, int null_runs, std::uint64_t seed) {
  std::vector<Line> lines;
  for (double f : MainsIn(blocks)) {
    for (int c = 0; c < static_cast<int>(scale.channels.size()); ++c) {
      lines.push_back(LineAt(blocks, c, f, scale.channels[static_cast<std::size_t>(c)]));
    }
  }
  if (lines.empty()) return {};
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.log_ratio > b.log_ratio; });
  Eigen::VectorXd statistic(1 + null_runs);
  statistic[0] = lines.front().log_ratio;
  Stream stream(seed, "screen.raw.hum");
  for (int j = 1; j <= null_runs; ++j) {
    statistic[j] = NullMaximum(stream, lines.size(), static_cast<double>(blocks.Blocks()));
  }
  ScreenTest test;
  test.name = "raw: hum";
  test.statistic = statistic[0];
  test.p = PValue(statistic);
  test.effect_m = lines.front().amplitude * scale.code_SI;
  test.reading =
      "loudest mains line inside the blocks: " + lines.front().name + ": hum in cables, lamps or supplies";
  for (const Line& line : lines)
    test.tables.push_back(fmt::format("{}: amplitude {:.3g} codes", line.name, line.amplitude));
  return {std::move(test)};
}

}  // namespace twinbench::diagnose::screen
