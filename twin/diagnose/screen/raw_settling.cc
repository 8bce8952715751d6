#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/sample.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr Eigen::Index kLeastScans = 32;

/// One channel of one block.
Eigen::ArrayXd Codes(const RawBlock& block, int channel) {
  using Column = Eigen::Matrix<std::int16_t, Eigen::Dynamic, 1>;
  const Eigen::Map<const Column, 0, Eigen::InnerStride<>> codes(block.samples.data() + channel,
                                                                std::ssize(block.samples) / block.channels,
                                                                Eigen::InnerStride<>(block.channels));
  return codes.cast<double>().array();
}

/// What is faster than three scans: hum and drift are not in it. The weights -1/2, 1, -1/2 turn white noise of unit
/// variance into noise with the covariances 3/2, -1, 1/4.
Eigen::ArrayXd Fast(const Eigen::ArrayXd& x) {
  const Eigen::Index n = x.size() - 2;
  return x.segment(1, n) - 0.5 * (x.head(n) + x.tail(n));
}

/// A deviation from independent samples: a normal score and what it means.
struct Trace {
  std::string name;
  int channel = 0;
  double score = 0.0;
  double share = kNaN;  // of the sample before
  double codes = kNaN;  // size in a reading; NaN: it does not reach the mean
};

/// Running sums over the blocks of one channel and the one that is converted before it.
struct Sums {
  double pair = 0.0, own = 0.0, before = 0.0;      // products of what is fast
  double lag1 = 0.0, lag2 = 0.0;                   // mean squared differences
  double first = 0.0, rest_square = 0.0;           // of the first sample, of the others, from the others' mean
  double scans = 0.0, blocks = 0.0, others = 0.0;  // counts; others: degrees of freedom of rest_square
  double rim = 0.0;                                // largest level of the channel before, codes
};

/// @param same_scan  False for the first channel of a scan: the one before it is the last of the scan before.
void Add(const RawBlock& block, int channel, int before, bool same_scan, Sums& s) {
  const Eigen::ArrayXd x = Codes(block, channel), y = Codes(block, before);
  const Eigen::Index n = x.size();
  if (n < kLeastScans) return;
  const Eigen::ArrayXd a = Fast(x), b = Fast(y);
  const Eigen::Index pairs = a.size() - (same_scan ? 0 : 1);
  s.pair += (a.tail(pairs) * b.head(pairs)).sum();
  s.own += a.square().sum(), s.before += b.square().sum();
  s.lag1 += (x.tail(n - 1) - x.head(n - 1)).square().mean();
  s.lag2 += (x.tail(n - 2) - x.head(n - 2)).square().mean();
  const double mean = x.tail(n - 1).mean();
  s.first += x[0] - mean;
  s.rest_square += (x.tail(n - 1) - mean).square().sum();
  s.scans += static_cast<double>(n), s.blocks += 1.0, s.others += static_cast<double>(n - 2);
  s.rim = std::max(s.rim, std::abs(y.mean()));
}

/// The variance of a correlation of fast parts is (9/4 + 2 + 1/8) / (9/4) = 1.94 a scan.
Trace Ghost(const Sums& s, int channel, const RawScale& scale, int before) {
  const double share = s.pair / std::max(s.before, 1e-300);
  const double correlation = s.pair / std::sqrt(std::max(s.own * s.before, 1e-300));
  const auto name = [&](int c) { return scale.channels[static_cast<std::size_t>(c)].name; };
  return {fmt::format("{:+.2g} of {} stays in {}", share, name(before), name(channel)), channel,
          correlation * std::sqrt(s.others / 1.9444), share, std::abs(share) * s.rim};
}

/// With memory k of the sample before, squared differences over one scan and over two are as 1 to 1 + k.
Trace Memory(const Sums& s, int channel, const RawScale& scale) {
  const double share = s.lag2 / std::max(s.lag1, 1e-300) - 1.0;
  return {fmt::format("{:+.2g} of the sample before stays in {}", share,
                      scale.channels[static_cast<std::size_t>(channel)].name),
          channel, std::log1p(share) * std::sqrt(0.5 * s.scans), share, kNaN};
}

Trace FirstSample(const Sums& s, int channel, const RawScale& scale) {
  const double step = s.first / s.blocks, variance = s.rest_square / s.others;
  const double u = std::sqrt(variance * (1.0 / s.blocks + 1.0 / (s.scans - s.blocks)));
  const std::string& name = scale.channels[static_cast<std::size_t>(channel)].name;
  return {fmt::format("the first sample of {} is off by {:+.2g} codes", name, step), channel,
          u > 0.0 ? step / u : 0.0, kNaN, std::abs(step) * s.blocks / s.scans};
}

std::vector<Trace> TracesOf(const std::vector<RawBlock>& blocks, const RawScale& scale) {
  std::vector<Trace> traces;
  const std::size_t channels = scale.scan.size();
  for (std::size_t place = 0; place < channels; ++place) {
    const int channel = scale.scan[place], before = scale.scan[(place + channels - 1) % channels];
    Sums sums;
    for (const RawBlock& block : blocks) Add(block, channel, before, place > 0, sums);
    if (sums.blocks < 1.0) continue;
    if (channels > 1) traces.push_back(Ghost(sums, channel, scale, before));
    traces.push_back(Memory(sums, channel, scale));
    traces.push_back(FirstSample(sums, channel, scale));
  }
  std::sort(traces.begin(), traces.end(),
            [](const Trace& a, const Trace& b) { return std::abs(a.score) > std::abs(b.score); });
  return traces;
}

double LargestNullTrace(Stream& stream, std::size_t traces) {
  double largest = 0.0;
  for (std::size_t k = 0; k < traces; ++k) largest = std::max(largest, std::abs(stream.Normal()));
  return largest;
}

}  // namespace

/// A converter or amplifier that has not settled when the next sample is taken keeps some of what came before: of
/// the channel converted before (multiplexer), of the sample before (bandwidth), of the time before the block.
Tests TestSettling(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs, std::uint64_t seed) {
  const std::vector<Trace> traces = TracesOf(blocks, scale);
  if (traces.empty()) return {};
  Eigen::VectorXd statistic(1 + null_runs);
  statistic[0] = std::abs(traces.front().score);
  Stream stream(seed, "screen.raw.settling");
  for (int j = 1; j <= null_runs; ++j) statistic[j] = LargestNullTrace(stream, traces.size());
  ScreenTest test;
  test.name = "raw: settling";
  test.statistic = statistic[0];
  test.p = PValue(statistic);
  SetRawEffect(scale.channels[static_cast<std::size_t>(traces.front().channel)], traces.front().codes, test);
  test.reading =
      traces.front().name + ": a multiplexer or amplifier that has not settled, or noise that is not white";
  for (const Trace& t : traces) test.tables.push_back(fmt::format("{}: score {:.1f}", t.name, t.score));
  return {std::move(test)};
}

}  // namespace twinbench::diagnose::screen
