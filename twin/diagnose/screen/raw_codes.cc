#include <algorithm>
#include <array>
#include <cmath>

#include "twin/diagnose/screen/raw_tests.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kCodes = 65536, kReach = 4, kAround = 12;

/// What the four codes on either side say of the code between: the parabola of least variance through them,
/// w = a + b h^2 with 2 sum w = 1 and 2 sum w h^2 = 0. Its variance is `kVariance` of one count's.
constexpr std::array<double, kReach> kWeights = {0.313953, 0.226744, 0.081395, -0.122093};
constexpr double kVariance = 0.343023;

/// Sum of both neighbours at distances from `nearest` on, each distance with its weight.
template <typename Counts, typename Weight>
double SumBeside(const Counts& counts, int code, int nearest, int farthest, const Weight& weight) {
  double sum = 0.0;
  for (int h = nearest; h <= farthest; ++h)
    sum += weight(h) * (static_cast<double>(counts[code - h]) + static_cast<double>(counts[code + h]));
  return sum;
}

template <typename Counts>
double FromNeighbours(const Counts& counts, int code) {
  return SumBeside(counts, code, 1, kReach, [](int h) { return kWeights[h - 1]; });
}

/// Typical count of the codes beyond those that FromNeighbours looks at: a code is judged where this is large
/// enough, and so not because its own neighbours happened to come often.
double Around(const std::vector<double>& counts, int code) {
  return 0.5 * SumBeside(counts, code, kReach + 1, kAround, [](int) { return 1.0; }) / (kAround - kReach);
}

/// How often each code came, shifted so that the lowest has index 0; and the scatter within blocks.
struct Density {
  std::vector<double> count = std::vector<double>(kCodes, 0.0);
  double scatter = 0.0;
};

Density DensityOf(const std::vector<RawBlock>& blocks, int channel) {
  Density density;
  double squares = 0.0, total = 0.0;
  for (const RawBlock& block : blocks) {
    const Eigen::ArrayXd codes = Codes(block, channel);
    for (double code : codes) density.count[static_cast<int>(code) + kCodes / 2] += 1.0;
    if (codes.size() > 0) squares += (codes - codes.mean()).square().sum();
    total += static_cast<double>(codes.size());
  }
  density.scatter = total > 0.0 ? std::sqrt(squares / total) : 0.0;
  return density;
}

/// Roots of Poisson counts have unit variance and, with the second constant for the quieter mean of neighbours, the
/// same expectation (Anscombe, Biometrika 35 (1948) 246-254).
double ScoreOf(double count, double expected) {
  constexpr double kAnscombe = 0.375, kAnscombeOfMean = kAnscombe - 0.25 * (1.0 - kVariance);
  const double difference = 2.0 * (std::sqrt(count + kAnscombe) - std::sqrt(expected + kAnscombeOfMean));
  return std::abs(difference) / std::sqrt(1.0 + kVariance);
}

RawItem ItemAt(const RawSample& s, const std::vector<double>& count, int channel, int index) {
  const double came = count[index], expected = std::max(0.0, FromNeighbours(count, index));
  return {ItemOf("raw: code density", index - kCodes / 2, s.Name(channel), came, expected,
                 came == 0.0 ? " (missing)" : ""),
          channel, ScoreOf(came, expected), std::abs(came / std::max(expected, 1.0) - 1.0)};
}

/// Largest score of as many codes in a row without fault.
double LargestOfNoise(Stream& noise, int codes) {
  std::vector<float> g((codes + 2 * kReach + 3) / 4 * 4);
  noise.FillNormals(g);
  double largest = 0.0;
  for (int k = kReach; k < codes + kReach; ++k)
    largest = std::max(largest, std::abs(static_cast<double>(g[k]) - FromNeighbours(g, k)));
  return largest / std::sqrt(1.0 + kVariance);
}

}  // namespace

/// Code density: a code's width is how often it comes, compared with its neighbours.
void TestCodes(const RawSample& s, Tests& tests) {
  constexpr double kLeastCount = 25.0;   // around a code; below, square roots of counts are no longer normal
  constexpr double kLeastScatter = 4.0;  // codes; below, the density bends within kReach
  constexpr std::size_t kLines = 8;
  std::vector<RawItem> codes;
  for (int c = 0; c < s.Channels(); ++c) {
    const auto& [count, scatter] = DensityOf(s.blocks, c);
    for (int k = kAround; k < kCodes - kAround && scatter >= kLeastScatter; ++k) {
      if (Around(count, k) >= kLeastCount) codes.push_back(ItemAt(s, count, c, k));
    }
  }
  const auto draw = [judged = codes.size()](Stream& noise) {
    return LargestOfNoise(noise, static_cast<int>(judged));
  };
  std::ranges::sort(codes, std::greater<>(), &RawItem::score);
  codes.resize(std::min(kLines, codes.size()));
  TestLargest(s, "raw: code density", "screen.raw.codes", codes, draw, tests);
}

}  // namespace twinbench::diagnose::screen
