#include "twin/diagnose/screen/raw_blocks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "twin/core/errors.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr Eigen::Index kMostSamples = 2048;

Eigen::Index MedianScans(const std::vector<RawBlock>& blocks) {
  std::vector<Eigen::Index> scans;
  for (const RawBlock& b : blocks) scans.push_back(std::ssize(b.samples) / b.channels);
  std::nth_element(scans.begin(), scans.begin() + std::ssize(scans) / 2, scans.end());
  return scans[scans.size() / 2];
}

/// Means of `average` scans in a row, channels x samples.
Eigen::MatrixXd Averages(const RawBlock& block, Eigen::Index samples, int average) {
  const Eigen::Map<const Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic>> codes(
      block.samples.data(), block.channels, std::ssize(block.samples) / block.channels);
  Eigen::MatrixXd means(block.channels, samples);
  for (Eigen::Index i = 0; i < samples; ++i) {
    means.col(i) = codes.middleCols(i * average, average).cast<double>().rowwise().mean();
  }
  return means;
}

/// Orthonormal, orthogonal to a constant: samples x 2.
Eigen::MatrixXd Wave(double frequency_hz, double rate_hz, Eigen::Index first, Eigen::Index samples) {
  const Eigen::ArrayXd i =
      Eigen::ArrayXd::LinSpaced(samples, static_cast<double>(first), static_cast<double>(first + samples - 1));
  const Eigen::ArrayXd phase = 2.0 * std::numbers::pi * frequency_hz / rate_hz * i;
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
  thinned.rate_hz = scale.scan_rate_hz / thinned.average;
  std::vector<Eigen::MatrixXd> used;
  for (const RawBlock& b : blocks) {
    if (std::ssize(b.samples) / b.channels >= scans) used.push_back(Averages(b, samples, thinned.average));
  }
  for (Eigen::Index c = 0; c < std::ssize(scale.channels); ++c) {
    Eigen::MatrixXd channel(samples, std::ssize(used));
    for (std::size_t k = 0; k < used.size(); ++k)
      channel.col(static_cast<Eigen::Index>(k)) = used[k].row(c).transpose();
    thinned.channel.push_back(std::move(channel));
  }
  return thinned;
}

Eigen::VectorXd Power(const Eigen::MatrixXd& blocks, Eigen::Index first, Eigen::Index samples,
                      const std::vector<double>& frequency_hz, double rate_hz) {
  Eigen::VectorXd power(std::ssize(frequency_hz));
  for (std::size_t k = 0; k < frequency_hz.size(); ++k) {
    const Eigen::MatrixXd wave = Wave(frequency_hz[k], rate_hz, first, samples);
    power[static_cast<Eigen::Index>(k)] = (wave.transpose() * blocks.middleRows(first, samples)).squaredNorm();
  }
  return power;
}

}  // namespace twinbench::diagnose::screen
