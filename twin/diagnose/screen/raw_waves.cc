#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/screen/raw_tests.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr double kHighest = 0.45;  // of the sampling rate; above, a sine has next to no samples off zero

double LogRatio(double power, double to) {
  return std::log(std::max(power, 1e-300) / std::max(to, 1e-300));
}

/// A frequency of the mains and where the thinned samples show it: those above half their rate are folded back.
struct Mains {
  std::string name;  // "50 Hz", "50 or 120 Hz (seen at 20 Hz)" where both fold onto one
  double true_Hz = kNaN, shown_Hz = kNaN;
};

/// The lines that the blocks hold at least once. Those that are shown at the same place cannot be told apart.
std::vector<Mains> MainsIn(const ThinnedBlocks& blocks) {
  std::vector<Mains> mains;
  for (double f : {50.0, 60.0, 100.0, 120.0}) {
    const double shown_Hz = std::abs(f - std::round(f / blocks.rate_Hz) * blocks.rate_Hz);
    if (shown_Hz * blocks.Duration_s() < 1.0 - 1e-9 || !(shown_Hz < kHighest * blocks.rate_Hz)) continue;
    const auto same = std::ranges::find_if(
        mains, [&](const Mains& other) { return std::abs(other.shown_Hz - shown_Hz) < 1e-6 * f; });
    if (same == mains.end())
      mains.push_back({fmt::format("{:.0f}", f), f, shown_Hz});
    else
      same->name += fmt::format(" or {:.0f}", f);
  }
  for (Mains& m : mains)
    m.name += m.shown_Hz == m.true_Hz ? " Hz" : fmt::format(" Hz (seen at {:.3g} Hz)", m.shown_Hz);
  return mains;
}

/// The floor beside a line: whole cycles a block away on both sides, the next one left out; on one side only where
/// the band ends.
std::vector<double> Neighbours(double shown_Hz, const ThinnedBlocks& blocks) {
  constexpr int kNeighbours = 6;
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
  const double x = units::kPi * true_Hz / blocks.rate_Hz;
  return std::abs(std::sin(x) / (blocks.average * std::sin(x / blocks.average)));
}

/// The largest of a number of draws.
template <typename Draw>
double LargestOf(Eigen::Index count, const Draw& draw) {
  double largest = -1e300;
  for (Eigen::Index k = 0; k < count; ++k) largest = std::max(largest, draw(k));
  return largest;
}

struct Line : RawItem {
  double floors = 0.0;  // neighbours that tell the floor
};

Line LineOn(const RawSample& s, int channel, const Mains& mains, const std::vector<double>& beside_Hz) {
  const Eigen::MatrixXd& samples = s.thinned.channel[channel];
  const auto power = [&](const std::vector<double>& frequency_Hz) {
    return Power(samples, 0, samples.rows(), frequency_Hz, s.thinned.rate_Hz).mean();
  };
  const double line = power({mains.shown_Hz}), floor = power(beside_Hz);
  const double each = std::max(0.0, line - floor) / static_cast<double>(samples.size());
  const double amplitude = std::sqrt(2.0 * each) / LeftByAveraging(mains.true_Hz, s.thinned);
  const std::string name = mains.name + " on " + s.Name(channel);
  return {{name, channel, LogRatio(line, floor), amplitude, ItemOf("raw: hum", name, amplitude)},
          static_cast<double>(beside_Hz.size())};
}

/// The frequency of one channel at which the first half of the blocks holds most more power than the second.
RawItem DecayOn(const RawSample& s, int channel, Eigen::Index half, Eigen::Index lines) {
  const double half_s = static_cast<double>(half) / s.thinned.rate_Hz;
  std::vector<double> frequency_Hz;
  for (int k = 1; k <= lines; ++k) frequency_Hz.push_back(k / half_s);
  const Eigen::MatrixXd& samples = s.thinned.channel[channel];
  const Eigen::VectorXd first = Power(samples, 0, half, frequency_Hz, s.thinned.rate_Hz);
  const Eigen::VectorXd second = Power(samples, half, half, frequency_Hz, s.thinned.rate_Hz);
  int at = 0;
  const double ratio = first.binaryExpr(second, &LogRatio).maxCoeff(&at);
  const double mean_square = std::max(0.0, first[at] - second[at]) / static_cast<double>(half * samples.cols());
  return {ItemOf("raw: ring-down", s.Name(channel), frequency_Hz[at], 2.0 * half_s / std::max(ratio, 1e-9)),
          channel, ratio, std::sqrt(2.0 * mean_square)};
}

}  // namespace

void TestHum(const RawSample& s, Tests& tests) {
  std::vector<Line> lines;
  for (const Mains& mains : MainsIn(s.thinned)) {
    const std::vector<double> beside_Hz = Neighbours(mains.shown_Hz, s.thinned);
    for (int c = 0; c < s.Channels() && !beside_Hz.empty(); ++c) lines.push_back(LineOn(s, c, mains, beside_Hz));
  }
  std::ranges::sort(lines, std::greater<>(), &Line::score);
  const double dof = 2.0 * static_cast<double>(s.thinned.Blocks());
  const auto draw = [&](Stream& noise) {
    return LargestOf(std::ssize(lines), [&](Eigen::Index k) {
      const double floor = noise.ChiSquared(dof * lines[k].floors) / lines[k].floors;
      return std::log(noise.ChiSquared(dof) / floor);
    });
  };
  TestLargest(s, "raw: hum", "screen.raw.hum", {lines.begin(), lines.end()}, draw, tests);
}

/// A vibration that the move has started dies out: at its frequency, the first half of a block holds more power
/// than the second. Frequencies are whole cycles a half block; the decay follows from the ratio.
void TestRingDown(const RawSample& s, Tests& tests) {
  constexpr Eigen::Index kMostLines = 64;
  const Eigen::Index half = s.thinned.Samples() / 2, lines = std::min(kMostLines, half / 4);
  if (lines < 2) return;
  std::vector<RawItem> decays;
  for (int c = 0; c < s.Channels(); ++c) decays.push_back(DecayOn(s, c, half, lines));
  const double dof = 2.0 * static_cast<double>(s.thinned.Blocks());
  const auto draw = [&](Stream& noise) {
    return LargestOf(s.Channels() * lines, [&](Eigen::Index) {
      const double first = noise.ChiSquared(dof);
      return std::log(first / noise.ChiSquared(dof));
    });
  };
  TestLargest(s, "raw: ring-down", "screen.raw.ring", decays, draw, tests);
}

}  // namespace twinbench::diagnose::screen
