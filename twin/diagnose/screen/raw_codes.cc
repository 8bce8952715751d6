#include <algorithm>
#include <array>
#include <cmath>

#include "twin/diagnose/screen/raw_tests.h"
#include "twin/diagnose/screen/words.h"

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

struct CodeScore {
  int channel = 0, code = 0;
  double count = 0.0, expected = 0.0;
  double score = 0.0;
};

/// Roots of Poisson counts have unit variance and, with the second constant for the quieter mean of neighbours, the
/// same expectation (Anscombe, Biometrika 35 (1948) 246-254).
double ScoreOf(double count, double expected) {
  constexpr double kAnscombe = 0.375, kAnscombeOfMean = kAnscombe - 0.25 * (1.0 - kVariance);
  const double difference = 2.0 * (std::sqrt(count + kAnscombe) - std::sqrt(expected + kAnscombeOfMean));
  return std::abs(difference) / std::sqrt(1.0 + kVariance);
}

std::vector<CodeScore> ScoresOf(const RawSample& s) {
  constexpr double kLeastCount = 25.0;   // around a code; below, square roots of counts are no longer normal
  constexpr double kLeastScatter = 4.0;  // codes; below, the density bends within kReach
  std::vector<CodeScore> scores;
  for (int c = 0; c < s.Channels(); ++c) {
    const auto& [count, scatter] = DensityOf(s.blocks, c);
    for (int k = kAround; k < kCodes - kAround && scatter >= kLeastScatter; ++k) {
      if (Around(count, k) < kLeastCount) continue;
      const double expected = std::max(0.0, FromNeighbours(count, k));
      scores.push_back({c, k - kCodes / 2, count[k], expected, ScoreOf(count[k], expected)});
    }
  }
  std::ranges::sort(scores, std::greater<>(), &CodeScore::score);
  return scores;
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
  constexpr std::size_t kLines = 8;
  const std::vector<CodeScore> scores = ScoresOf(s);
  if (scores.empty()) return;
  const CodeScore& worst = scores.front();
  const auto draw = [&](Stream& noise) { return LargestOfNoise(noise, static_cast<int>(scores.size())); };
  ScreenTest test = Simulated(s, "raw: code density", worst.score, "screen.raw.codes", draw);
  SetEffect(s.scale.channels[worst.channel], std::abs(worst.count / std::max(worst.expected, 1.0) - 1.0), test);
  for (std::size_t k = 0; k < std::min(kLines, scores.size()); ++k) {
    const auto& [channel, code, count, expected, score] = scores[k];
    test.tables.push_back(
        ItemOf(test.name, code, s.Name(channel), count, expected, count == 0.0 ? " (missing)" : ""));
  }
  test.reading = ReadingOf(test.name, test.tables.front());
  tests.push_back(std::move(test));
}

}  // namespace twinbench::diagnose::screen
