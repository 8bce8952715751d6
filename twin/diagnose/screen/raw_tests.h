#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/screen.h"
#include "twin/diagnose/screen/significance.h"

/// Tests of the samples inside the raw blocks; each adds what it finds if the blocks are long enough for it.
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

/// What the tests look at, and how their nulls are drawn.
struct RawSample {
  const std::vector<RawBlock>& blocks;
  const RawScale& scale;
  ThinnedBlocks thinned;
  int null_runs = 0;
  std::uint64_t seed = 1;

  int Channels() const { return static_cast<int>(scale.channels.size()); }
  const std::string& Name(int channel) const { return scale.channels[channel].name; }
};

/// One of the deviations that a test looks for, and its size.
struct RawItem {
  std::string name;
  int channel = 0;
  double score = kNaN;
  double codes = kNaN;    // size in a reading; NaN: it does not reach the mean
  std::string line = {};  // of the table; else the name
};

/// Adds the test of the largest score, compared with what `draw` takes from the stream of this name for the largest
/// score in independent Gaussian samples; nothing if there is no item.
void TestLargest(const RawSample& sample, const std::string& test, const char* stream,
                 const std::vector<RawItem>& items, const std::function<double(Stream&)>& draw, Tests& tests);

/// One channel of a block, scan by scan.
Eigen::ArrayXd Codes(const RawBlock& block, int channel);

/// Power at each frequency in samples [first, first + samples), summed over the blocks: least squares of cosine and
/// sine beside a free constant. White noise of unit variance gives chi-squared of 2 * blocks degrees of freedom.
Eigen::VectorXd Power(const Eigen::MatrixXd& blocks, Eigen::Index first, Eigen::Index samples,
                      const std::vector<double>& frequency_Hz, double rate_Hz);

/// A size in codes of one channel.
void SetEffect(const RawChannel& channel, double codes, ScreenTest& test);

void TestHum(const RawSample& sample, Tests& tests);       // lines of the mains
void TestRingDown(const RawSample& sample, Tests& tests);  // vibration that dies out
void TestRawAllan(const RawSample& sample, Tests& tests);  // scatter of means
void TestCodes(const RawSample& sample, Tests& tests);     // code density
void TestSettling(const RawSample& sample, Tests& tests);  // what a sample keeps of the ones before

}  // namespace twinbench::diagnose::screen
