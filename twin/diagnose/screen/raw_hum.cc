#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/sample.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kNeighbours = 6;
constexpr double kHighest = 0.45;  // of the sampling rate; above, a sine has next to no samples off zero

/// A frequency of the mains and where the thinned samples show it: those above half their rate are folded back.
struct Mains {
  std::string name;  // "50 Hz", "50 or 120 Hz (seen at 20 Hz)" where both fold onto one
  double true_Hz = kNaN, shown_Hz = kNaN;
};

/// Frequencies that are shown at the same place cannot be told apart.
std::vector<Mains> Named(const std::vector<Mains>& mains) {
  std::vector<Mains> named;
  for (const Mains& m : mains) {
    const auto same = std::ranges::find_if(
        named, [&m](const Mains& other) { return std::abs(other.shown_Hz - m.shown_Hz) < 1e-6 * m.true_Hz; });
    if (same != named.end())
      same->name += fmt::format(" or {:.0f}", m.true_Hz);
    else
      named.push_back({fmt::format("{:.0f}", m.true_Hz), m.true_Hz, m.shown_Hz});
  }
  for (Mains& m : named)
    m.name += m.shown_Hz == m.true_Hz ? " Hz" : fmt::format(" Hz (seen at {:.3g} Hz)", m.shown_Hz);
  return named;
}

/// The lines that the blocks hold at least once.
std::vector<Mains> MainsIn(const ThinnedBlocks& blocks) {
  std::vector<Mains> mains;
  for (double f : {50.0, 60.0, 100.0, 120.0}) {
    const double shown_Hz = std::abs(f - std::round(f / blocks.rate_Hz) * blocks.rate_Hz);
    if (shown_Hz * blocks.Duration_s() >= 1.0 - 1e-9 && shown_Hz < kHighest * blocks.rate_Hz)
      mains.push_back({"", f, shown_Hz});
  }
  return Named(mains);
}

/// The floor beside a line: whole cycles a block away on both sides, the next one left out; on one side only where
/// the band ends.
std::vector<double> Neighbours(double shown_Hz, const ThinnedBlocks& blocks) {
  const double step_Hz = 1.0 / blocks.Duration_s(), highest_Hz = kHighest * blocks.rate_Hz;
  std::vector<double> beside_Hz;
  for (int k = 2; k <= 1 + kNeighbours && std::ssize(beside_Hz) < kNeighbours; ++k) {
    if (shown_Hz - k * step_Hz > 0.5 * step_Hz) beside_Hz.push_back(shown_Hz - k * step_Hz);
    if (shown_Hz + k * step_Hz < highest_Hz) beside_Hz.push_back(shown_Hz + k * step_Hz);
  }
  return beside_Hz;
}

/// What averaging `average` scans leaves of a wave.
double LeftByAveraging(double true_Hz, const ThinnedBlocks& blocks) {
  const double x = std::numbers::pi * true_Hz / blocks.rate_Hz;
  return std::abs(std::sin(x) / (blocks.average * std::sin(x / blocks.average)));
}

struct Line {
  std::string name;
  std::size_t channel = 0;
  double log_ratio = kNaN;  // of its power to the floor's
  double amplitude = kNaN;  // codes
  double floors = 0.0;      // neighbours that tell the floor
};

Line LineAt(const ThinnedBlocks& blocks, std::size_t channel, const Mains& mains, const std::string& name) {
  const Eigen::MatrixXd& samples = blocks.channel[channel];
  const std::vector<double> beside_Hz = Neighbours(mains.shown_Hz, blocks);
  const double line = Power(samples, 0, samples.rows(), {mains.shown_Hz}, blocks.rate_Hz)[0];
  const double floor = Power(samples, 0, samples.rows(), beside_Hz, blocks.rate_Hz).mean();
  const double each = std::max(0.0, line - floor) / static_cast<double>(samples.size());
  return {mains.name + " on " + name, channel, std::log(std::max(line, 1e-300) / std::max(floor, 1e-300)),
          std::sqrt(2.0 * each) / LeftByAveraging(mains.true_Hz, blocks),
          static_cast<double>(std::ssize(beside_Hz))};
}

std::vector<Line> LinesIn(const ThinnedBlocks& blocks, const RawScale& scale) {
  std::vector<Line> lines;
  for (const Mains& mains : MainsIn(blocks)) {
    if (Neighbours(mains.shown_Hz, blocks).empty()) continue;
    for (std::size_t c = 0; c < scale.channels.size(); ++c)
      lines.push_back(LineAt(blocks, c, mains, scale.channels[c].name));
  }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.log_ratio > b.log_ratio; });
  return lines;
}

/// Largest log ratio of these lines to their floors in white noise.
double NullMaximum(Stream& stream, const std::vector<Line>& lines, double blocks) {
  double largest = -1e300;
  for (const Line& line : lines) {
    const double floor = stream.ChiSquared(2.0 * blocks * line.floors) / line.floors;
    largest = std::max(largest, std::log(stream.ChiSquared(2.0 * blocks) / floor));
  }
  return largest;
}

}  // namespace

Tests TestHum(const ThinnedBlocks& blocks, const RawScale& scale, int null_runs, std::uint64_t seed) {
  const std::vector<Line> lines = LinesIn(blocks, scale);
  if (lines.empty()) return {};
  Eigen::VectorXd statistic(1 + null_runs);
  statistic[0] = lines.front().log_ratio;
  Stream stream(seed, "screen.raw.hum");
  for (int j = 1; j <= null_runs; ++j)
    statistic[j] = NullMaximum(stream, lines, static_cast<double>(blocks.Blocks()));
  ScreenTest test;
  test.name = "raw: hum";
  test.statistic = statistic[0];
  test.p = PValue(statistic);
  SetRawEffect(scale.channels[lines.front().channel], lines.front().amplitude, test);
  test.reading =
      fmt::format("the samples carry a wave of {}: mains hum in cables, lamps or supplies", lines.front().name);
  for (const Line& line : lines)
    test.tables.push_back(fmt::format("{}: amplitude {:.3g} codes", line.name, line.amplitude));
  return {std::move(test)};
}

}  // namespace twinbench::diagnose::screen
