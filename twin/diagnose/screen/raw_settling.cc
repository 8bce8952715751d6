#include <algorithm>
#include <cmath>

#include "twin/diagnose/screen/raw_tests.h"

namespace twinbench::diagnose::screen {
namespace {

/// What is faster than three scans: hum and drift are not in it. The weights -1/2, 1, -1/2 turn white noise of unit
/// variance into noise with the covariances 3/2, -1, 1/4.
Eigen::ArrayXd Fast(const Eigen::ArrayXd& x) {
  const Eigen::Index n = x.size() - 2;
  return x.segment(1, n) - 0.5 * (x.head(n) + x.tail(n));
}

/// Mean squared difference of samples that lie `lag` scans apart.
double LagSquare(const Eigen::ArrayXd& x, Eigen::Index lag) {
  return (x.tail(x.size() - lag) - x.head(x.size() - lag)).square().mean();
}

/// A deviation from independent samples.
/// @param score  Normal.
RawItem Trace(const std::string& name, int channel, double score, double codes) {
  return {name, channel, std::abs(score), codes, ItemOf("raw: settling", name, score)};
}

/// Running sums over the blocks of one channel and the one that is converted before it.
struct Sums {
  double pair = 0.0, own = 0.0, before = 0.0;      // products of what is fast
  double lag1 = 0.0, lag2 = 0.0;                   // mean squared differences
  double first = 0.0, rest_square = 0.0;           // of the first sample, of the others, from the others' mean
  double scans = 0.0, blocks = 0.0, others = 0.0;  // counts; others: degrees of freedom of rest_square
  double rim = 0.0;                                // largest level of the channel before, codes
};

/// @param same_scan  False for the first channel of a scan: the one before it is the last of the scan before.
void Add(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y, bool same_scan, Sums& s) {
  constexpr Eigen::Index kLeastScans = 32;
  const Eigen::Index n = x.size();
  if (n < kLeastScans) return;
  const Eigen::ArrayXd a = Fast(x), b = Fast(y);
  const Eigen::Index pairs = a.size() - (same_scan ? 0 : 1);
  s.pair += (a.tail(pairs) * b.head(pairs)).sum();
  s.own += a.square().sum(), s.before += b.square().sum();
  s.lag1 += LagSquare(x, 1), s.lag2 += LagSquare(x, 2);
  const double mean = x.tail(n - 1).mean();
  s.first += x[0] - mean;
  s.rest_square += (x.tail(n - 1) - mean).square().sum();
  s.scans += static_cast<double>(n), s.blocks += 1.0, s.others += static_cast<double>(n - 2);
  s.rim = std::max(s.rim, std::abs(y.mean()));
}

/// Multiplexer. The variance of a correlation of fast parts is (9/4 + 2 + 1/8) / (9/4) = 1.94 a scan.
RawItem ChannelBefore(const RawSample& raw, const Sums& s, int channel, int before) {
  const double share = s.pair / std::max(s.before, 1e-300);
  const double correlation = s.pair / std::sqrt(std::max(s.own * s.before, 1e-300));
  return Trace(ItemOf("raw: settling, channel before", share, raw.Name(before), raw.Name(channel)), channel,
               correlation * std::sqrt(s.others / 1.9444), std::abs(share) * s.rim);
}

/// Bandwidth. With memory k of the sample before, squared differences over one scan and over two are as 1 to 1 + k.
RawItem SampleBefore(const RawSample& raw, const Sums& s, int channel) {
  const double share = s.lag2 / std::max(s.lag1, 1e-300) - 1.0;
  return Trace(ItemOf("raw: settling, sample before", share, raw.Name(channel)), channel,
               std::log1p(share) * std::sqrt(0.5 * s.scans), kNaN);
}

/// The time before the block.
RawItem FirstSample(const RawSample& raw, const Sums& s, int channel) {
  const double step = s.first / s.blocks, variance = s.rest_square / s.others;
  const double u = std::sqrt(variance * (1.0 / s.blocks + 1.0 / (s.scans - s.blocks)));
  return Trace(ItemOf("raw: settling, first sample", raw.Name(channel), step), channel, u > 0.0 ? step / u : 0.0,
               std::abs(step) * s.blocks / s.scans);
}

}  // namespace

/// A converter or amplifier that has not settled when the next sample is taken keeps some of what came before.
void TestSettling(const RawSample& s, Tests& tests) {
  std::vector<RawItem> traces;
  const std::vector<int>& scan = s.scale.scan;
  for (std::size_t place = 0; place < scan.size(); ++place) {
    const int channel = scan[place], before = scan[(place + scan.size() - 1) % scan.size()];
    Sums sums;
    for (const RawBlock& block : s.blocks) Add(Codes(block, channel), Codes(block, before), place > 0, sums);
    if (sums.blocks < 1.0) continue;
    if (scan.size() > 1) traces.push_back(ChannelBefore(s, sums, channel, before));
    traces.push_back(SampleBefore(s, sums, channel));
    traces.push_back(FirstSample(s, sums, channel));
  }
  const auto draw = [&](Stream& noise) {
    double largest = 0.0;
    for (std::size_t k = 0; k < traces.size(); ++k) largest = std::max(largest, std::abs(noise.Normal()));
    return largest;
  };
  std::ranges::sort(traces, std::greater<>(), &RawItem::score);
  TestLargest(s, "raw: settling", "screen.raw.settling", traces, draw, tests);
}

}  // namespace twinbench::diagnose::screen
