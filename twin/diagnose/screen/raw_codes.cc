#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/sample.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kCodes = 65536, kReach = 4, kAround = 12;
constexpr double kLeastCount = 25.0;   // around a code; below, square roots of counts are no longer normal
constexpr double kLeastScatter = 4.0;  // codes; below, the density bends within kReach

/// What the four codes on either side say of the code between: the parabola of least variance through them,
/// w = a + b h^2 with 2 sum w = 1 and 2 sum w h^2 = 0. Its variance is `kVariance` of one count's.
constexpr std::array<double, kReach> kWeights = {0.313953, 0.226744, 0.081395, -0.122093};
constexpr double kVariance = 0.343023;

/// Roots of Poisson counts have unit variance and, with the second constant for the quieter mean of neighbours, the
/// same expectation (Anscombe, Biometrika 35 (1948) 246-254).
constexpr double kAnscombe = 0.375, kAnscombeOfMean = kAnscombe - 0.25 * (1.0 - kVariance);

template <typename At>
double FromNeighbours(const At& at, int code) {
  double sum = 0.0;
  for (int h = 1; h <= kReach; ++h)
    sum += kWeights[static_cast<std::size_t>(h - 1)] * (at(code - h) + at(code + h));
  return sum;
}

/// Typical count of the codes beyond those that FromNeighbours looks at: a code is judged where this is large
/// enough, and so not because its own neighbours happened to come often.
template <typename At>
double Around(const At& at, int code) {
  double sum = 0.0;
  for (int h = kReach + 1; h <= kAround; ++h) sum += at(code - h) + at(code + h);
  return 0.5 * sum / (kAround - kReach);
}

/// How often each code came, shifted so that the lowest has index 0; and the scatter within blocks.
struct Density {
  std::vector<double> count = std::vector<double>(kCodes, 0.0);
  double scatter = 0.0;
};

Density DensityOf(const std::vector<RawBlock>& blocks, int channel) {
  Density density;
  double squares = 0.0, total = 0.0;
  for (const RawBlock& b : blocks) {
    double sum = 0.0, sum_squares = 0.0, n = 0.0;
    for (std::size_t i = static_cast<std::size_t>(channel); i < b.samples.size();
         i += static_cast<std::size_t>(b.channels)) {
      const double code = b.samples[i];
      density.count[static_cast<std::size_t>(b.samples[i] + kCodes / 2)] += 1.0;
      sum += code, sum_squares += code * code, n += 1.0;
    }
    if (n > 0.0) squares += sum_squares - sum * sum / n;
    total += n;
  }
  density.scatter = total > 0.0 ? std::sqrt(squares / total) : 0.0;
  return density;
}

struct CodeScore {
  int channel = 0, code = 0;
  double count = 0.0, expected = 0.0;
  double score = 0.0;
};

void ScoreCodes(const Density& density, int channel, std::vector<CodeScore>& scores) {
  const auto at = [&](int index) { return density.count[static_cast<std::size_t>(index)]; };
  for (int k = kAround; k < kCodes - kAround; ++k) {
    if (Around(at, k) < kLeastCount) continue;
    const double expected = std::max(0.0, FromNeighbours(at, k));
    const double difference = 2.0 * (std::sqrt(at(k) + kAnscombe) - std::sqrt(expected + kAnscombeOfMean));
    scores.push_back({channel, k - kCodes / 2, at(k), expected, std::abs(difference) / std::sqrt(1.0 + kVariance)});
  }
}

/// Largest score of as many codes in a row without fault.
double LargestNullCode(Stream& stream, std::size_t codes) {
  std::vector<float> g((codes + 2 * kReach + 3) / 4 * 4);
  stream.FillNormals(g);
  const auto at = [&](int index) { return static_cast<double>(g[static_cast<std::size_t>(index)]); };
  double largest = 0.0;
  for (int k = kReach; k < static_cast<int>(codes) + kReach; ++k) {
    largest = std::max(largest, std::abs(at(k) - FromNeighbours(at, k)) / std::sqrt(1.0 + kVariance));
  }
  return largest;
}

std::string CodeWords(const CodeScore& s, const RawScale& scale) {
  return fmt::format("code {} of {}: came {:.0f} times instead of {:.0f}{}", s.code,
                     scale.channels[static_cast<std::size_t>(s.channel)].name, s.count, s.expected,
                     s.count == 0.0 ? " (missing)" : "");
}

}  // namespace

/// Code density: a code's width is how often it comes, compared with its neighbours.
Tests TestCodes(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs, std::uint64_t seed) {
  std::vector<CodeScore> scores;
  for (int c = 0; c < static_cast<int>(scale.channels.size()); ++c) {
    const Density density = DensityOf(blocks, c);
    if (density.scatter >= kLeastScatter) ScoreCodes(density, c, scores);
  }
  if (scores.empty()) return {};
  Eigen::VectorXd statistic(1 + null_runs);
  Stream stream(seed, "screen.raw.codes");
  for (int j = 1; j <= null_runs; ++j) statistic[j] = LargestNullCode(stream, scores.size());
  std::sort(scores.begin(), scores.end(), [](const CodeScore& a, const CodeScore& b) { return a.score > b.score; });
  const CodeScore& worst = scores.front();
  statistic[0] = worst.score;
  ScreenTest test;
  test.name = "raw: code density";
  test.statistic = worst.score;
  test.p = PValue(statistic);
  SetRawEffect(scale.channels[static_cast<std::size_t>(worst.channel)],
               std::abs(worst.count / std::max(worst.expected, 1.0) - 1.0), test);
  test.reading = CodeWords(worst, scale) + ": a converter whose steps are not equal";
  for (std::size_t k = 0; k < 8 && k < scores.size(); ++k) test.tables.push_back(CodeWords(scores[k], scale));
  return {std::move(test)};
}

}  // namespace twinbench::diagnose::screen
