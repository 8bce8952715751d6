#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "twin/diagnose/screen/screen.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {

/// Blocks of equal length, thinned by averaging to at most 2048 samples: fast enough for vibration and mains.
struct ThinnedBlocks {
  std::vector<Eigen::MatrixXd> channel;  // one a channel: samples x blocks, codes
  double rate_Hz = kNaN;                 // after averaging
  int average = 1;                       // scans averaged to a sample

  Eigen::Index Samples() const { return channel.empty() ? 0 : channel.front().rows(); }
  Eigen::Index Blocks() const { return channel.empty() ? 0 : channel.front().cols(); }
  double Duration_s() const { return static_cast<double>(Samples()) / rate_Hz; }
};

/// Blocks shorter than the median length are left out, longer ones cut; of very many, every second or third is
/// taken.
ThinnedBlocks Thin(const std::vector<RawBlock>& blocks, const RawScale& scale);

/// Power at each frequency in samples [first, first + samples), summed over the blocks: least squares of cosine and
/// sine beside a free constant. White noise of unit variance gives chi-squared of 2 * blocks degrees of freedom.
Eigen::VectorXd Power(const Eigen::MatrixXd& blocks, Eigen::Index first, Eigen::Index samples,
                      const std::vector<double>& frequency_Hz, double rate_Hz);

/// A size in codes of one channel.
void SetRawEffect(const RawChannel& channel, double codes, ScreenTest& test);

Tests TestHum(const ThinnedBlocks& blocks, const RawScale& scale, int null_runs, std::uint64_t seed);
Tests TestRingDown(const ThinnedBlocks& blocks, const RawScale& scale, int null_runs, std::uint64_t seed);
Tests TestRawAllan(const ThinnedBlocks& blocks, const RawScale& scale, int null_runs, std::uint64_t seed);
Tests TestCodes(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs, std::uint64_t seed);
Tests TestSettling(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs, std::uint64_t seed);

}  // namespace twinbench::diagnose::screen
