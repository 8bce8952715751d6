#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/raw_tests.h"

namespace twinbench::diagnose {
namespace screen {
namespace {

Eigen::Index Scans(const RawBlock& block) {
  return std::ssize(block.samples) / block.channels;
}

Eigen::Index MedianScans(const std::vector<RawBlock>& blocks) {
  std::vector<double> scans;
  for (const RawBlock& b : blocks) scans.push_back(static_cast<double>(Scans(b)));
  return static_cast<Eigen::Index>(Median(scans));
}

/// Blocks that are long enough; of more values than kMostValues a channel every second, third, ...
std::vector<const RawBlock*> Used(const std::vector<RawBlock>& blocks, Eigen::Index scans, Eigen::Index samples) {
  constexpr std::size_t kMostValues = std::size_t{1} << 21;
  std::vector<const RawBlock*> used, kept;
  for (const RawBlock& b : blocks) {
    if (Scans(b) >= scans) used.push_back(&b);
  }
  const std::size_t every = (used.size() * static_cast<std::size_t>(samples) + kMostValues - 1) / kMostValues;
  for (std::size_t k = 0; k < used.size(); k += std::max<std::size_t>(1, every)) kept.push_back(used[k]);
  return kept;
}

/// Orthonormal cosine and sine, orthogonal to a constant: samples x 2.
Eigen::MatrixXd PureWave(double frequency_Hz, double rate_Hz, Eigen::Index first, Eigen::Index samples) {
  const Eigen::VectorXd i =
      Eigen::VectorXd::LinSpaced(samples, static_cast<double>(first), static_cast<double>(first + samples - 1));
  Eigen::MatrixXd wave = Wave(units::turn * frequency_Hz / rate_Hz * i);
  wave.rowwise() -= wave.colwise().mean().eval();
  wave.col(0).normalize();
  wave.col(1) -= wave.col(0) * wave.col(0).dot(wave.col(1));
  wave.col(1).normalize();
  return wave;
}

}  // namespace

ThinnedBlocks Thin(const std::vector<RawBlock>& blocks, const RawScale& scale) {
  constexpr Eigen::Index kMostSamples = 2048;  // a block
  ThinnedBlocks thinned;
  for (const RawBlock& b : blocks)
    Require(b.channels == std::ssize(scale.channels), "raw blocks have the channels of their scale");
  const Eigen::Index scans = blocks.empty() ? 0 : MedianScans(blocks);
  if (scans == 0) return thinned;
  thinned.average = static_cast<int>((scans + kMostSamples - 1) / kMostSamples);
  thinned.rate_Hz = scale.scan_rate_Hz / thinned.average;
  const Eigen::Index samples = scans / thinned.average;
  const std::vector<const RawBlock*> used = Used(blocks, scans, samples);
  for (int c = 0; c < std::ssize(scale.channels); ++c) {
    Eigen::MatrixXd channel(samples, std::ssize(used));
    for (int k = 0; k < std::ssize(used); ++k)
      channel.col(k) = Codes(*used[k], c)
                           .head(samples * thinned.average)
                           .reshaped(thinned.average, samples)
                           .colwise()
                           .mean()
                           .transpose();
    thinned.channel.push_back(std::move(channel));
  }
  return thinned;
}

void TestLargest(const RawSample& sample, const std::string& test, const char* stream,
                 const std::vector<RawItem>& items, const std::function<double(Stream&)>& draw, Tests& tests) {
  if (items.empty()) return;
  const RawItem& largest = *std::ranges::max_element(items, {}, &RawItem::score);
  Eigen::VectorXd statistic = Eigen::VectorXd::Constant(1 + sample.null_runs, largest.score);
  Stream noise(sample.seed, stream);
  for (int j = 1; j <= sample.null_runs; ++j) statistic[j] = draw(noise);
  tests.push_back(Tested(test, statistic));
  SetEffect(sample.scale.channels[largest.channel], largest.codes, tests.back());
  tests.back().reading = ReadingOf(test, largest.name);
  for (const RawItem& item : items) tests.back().tables.push_back(item.line.empty() ? item.name : item.line);
}

Eigen::ArrayXd Codes(const RawBlock& block, int channel) {
  using Column = Eigen::Array<std::int16_t, Eigen::Dynamic, 1>;
  const Eigen::Map<const Column, 0, Eigen::InnerStride<>> codes(block.samples.data() + channel, Scans(block),
                                                                Eigen::InnerStride<>(block.channels));
  return codes.cast<double>();
}

Eigen::VectorXd Power(const Eigen::MatrixXd& blocks, Eigen::Index first, Eigen::Index samples,
                      const std::vector<double>& frequency_Hz, double rate_Hz) {
  Eigen::VectorXd power(std::ssize(frequency_Hz));
  for (int k = 0; k < power.size(); ++k) {
    const Eigen::MatrixXd wave = PureWave(frequency_Hz[k], rate_Hz, first, samples);
    power[k] = (wave.transpose() * blocks.middleRows(first, samples)).squaredNorm();
  }
  return power;
}

void SetEffect(const RawChannel& channel, double codes, ScreenTest& test) {
  test.effect_m = codes * channel.code_SI;
  test.effect_rad = codes * channel.code_rad;
}

}  // namespace screen

std::string RawLimitsInWords(const std::vector<RawBlock>& blocks, const RawScale& scale) {
  constexpr double kMainsPeriod_s = 0.02;
  const double duration_s = screen::Thin(blocks, scale).Duration_s();
  if (blocks.empty() || duration_s > kMainsPeriod_s * (1.0 - 1e-9)) return "";
  return fmt::format(
      "Raw blocks of {:.3g} ms hold no whole period of the mains ({:.0f} ms): hum is not looked for in them, and "
      "shows only as scatter and tones of the readings.",
      1e3 * duration_s, 1e3 * kMainsPeriod_s);
}

}  // namespace twinbench::diagnose
