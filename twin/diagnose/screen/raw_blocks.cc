#include "twin/diagnose/screen/raw_blocks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "twin/core/errors.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr Eigen::Index kMostSamples = 2048;                // a block
constexpr std::size_t kMostValues = std::size_t{1} << 21;  // a channel

Eigen::Index Scans(const RawBlock& block) {
  return std::ssize(block.samples) / block.channels;
}

Eigen::Index MedianScans(const std::vector<RawBlock>& blocks) {
  std::vector<Eigen::Index> scans;
  for (const RawBlock& b : blocks) scans.push_back(Scans(b));
  std::nth_element(scans.begin(), scans.begin() + std::ssize(scans) / 2, scans.end());
  return scans[scans.size() / 2];
}

/// Blocks that are long enough, as many as fit into kMostValues.
std::vector<const RawBlock*> Used(const std::vector<RawBlock>& blocks, Eigen::Index scans, Eigen::Index samples) {
  std::vector<const RawBlock*> used;
  for (const RawBlock& b : blocks) {
    if (Scans(b) >= scans) used.push_back(&b);
  }
  const std::size_t every = (used.size() * static_cast<std::size_t>(samples) + kMostValues - 1) / kMostValues;
  if (every < 2) return used;
  std::vector<const RawBlock*> kept;
  for (std::size_t k = 0; k < used.size(); k += every) kept.push_back(used[k]);
  return kept;
}

/// Means of `average` scans in a row of one channel.
Eigen::VectorXd Averages(const RawBlock& block, Eigen::Index channel, Eigen::Index samples, int average) {
  using Codes = Eigen::Matrix<std::int16_t, Eigen::Dynamic, 1>;
  const Eigen::Map<const Codes, 0, Eigen::InnerStride<>> codes(block.samples.data() + channel, samples * average,
                                                               Eigen::InnerStride<>(block.channels));
  return codes.cast<double>().reshaped(average, samples).colwise().mean().transpose();
}

/// Orthonormal, orthogonal to a constant: samples x 2.
Eigen::MatrixXd Wave(double frequency_Hz, double rate_Hz, Eigen::Index first, Eigen::Index samples) {
  const Eigen::ArrayXd i =
      Eigen::ArrayXd::LinSpaced(samples, static_cast<double>(first), static_cast<double>(first + samples - 1));
  const Eigen::ArrayXd phase = 2.0 * std::numbers::pi * frequency_Hz / rate_Hz * i;
  Eigen::MatrixXd wave(samples, 2);
  wave << phase.cos(), phase.sin();
  wave.rowwise() -= wave.colwise().mean().eval();
  wave.col(0).normalize();
  wave.col(1) -= wave.col(0) * wave.col(0).dot(wave.col(1));
  wave.col(1).normalize();
  return wave;
}

}  // namespace

ThinnedBlocks Thin(const std::vector<RawBlock>& blocks, const RawScale& scale) {
  ThinnedBlocks thinned;
  for (const RawBlock& b : blocks) {
    Require(b.channels == std::ssize(scale.channels), "raw blocks have the channels of their scale");
  }
  if (blocks.empty()) return thinned;
  const Eigen::Index scans = MedianScans(blocks);
  thinned.average = static_cast<int>((scans + kMostSamples - 1) / kMostSamples);
  if (thinned.average == 0) return thinned;
  const Eigen::Index samples = scans / thinned.average;
  thinned.rate_Hz = scale.scan_rate_Hz / thinned.average;
  const std::vector<const RawBlock*> used = Used(blocks, scans, samples);
  for (Eigen::Index c = 0; c < std::ssize(scale.channels); ++c) {
    Eigen::MatrixXd channel(samples, std::ssize(used));
    for (std::size_t k = 0; k < used.size(); ++k)
      channel.col(static_cast<Eigen::Index>(k)) = Averages(*used[k], c, samples, thinned.average);
    thinned.channel.push_back(std::move(channel));
  }
  return thinned;
}

Eigen::VectorXd Power(const Eigen::MatrixXd& blocks, Eigen::Index first, Eigen::Index samples,
                      const std::vector<double>& frequency_Hz, double rate_Hz) {
  Eigen::VectorXd power(std::ssize(frequency_Hz));
  for (std::size_t k = 0; k < frequency_Hz.size(); ++k) {
    const Eigen::MatrixXd wave = Wave(frequency_Hz[k], rate_Hz, first, samples);
    power[static_cast<Eigen::Index>(k)] = (wave.transpose() * blocks.middleRows(first, samples)).squaredNorm();
  }
  return power;
}

void SetRawEffect(const RawChannel& channel, double codes, ScreenTest& test) {
  test.effect_m = codes * channel.code_SI;
  test.effect_rad = codes * channel.code_rad;
}

}  // namespace twinbench::diagnose::screen
