#include "hw_bridge/ad/block_checks.h"

#include <algorithm>
#include <cmath>

#include "hw_bridge/ad/mains_hum.h"
#include "twin/core/block_statistics.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

using Raw = std::span<const std::int16_t>;
using PerChannel = std::array<double, kChannels>;
const double kRoundingNoise_lsb = std::sqrt(1.0 / 12.0);

double ScansIn(Raw raw) {
  return static_cast<double>(raw.size() / kChannels);
}

double SecondSmallest(PerChannel values) {
  std::nth_element(values.begin(), values.begin() + 1, values.end());
  return values[1];
}

// --- one channel ---

struct ChannelView {
  double mean_lsb = 0.0;
  double std_lsb = 0.0;
  double noise_lsb = 0.0;  // from neighbours
  double drift_lsb = 0.0;  // along the block, of the best straight line
  int longest_run = 0;
  bool saturated = false;
};

double NeighbourNoise_lsb(Raw raw, std::size_t k) {
  double squares = 0.0;
  for (std::size_t i = k + kChannels; i < raw.size(); i += kChannels) {
    const double step = raw[i] - raw[i - kChannels];
    squares += step * step;
  }
  return ScansIn(raw) < 2.0 ? 0.0 : std::sqrt(squares / (2.0 * (ScansIn(raw) - 1.0)));
}

double Drift_lsb(Raw raw, std::size_t k, double mean_lsb) {
  const double n = ScansIn(raw), middle = 0.5 * (n - 1.0);
  double weighted = 0.0, scan = 0.0;
  for (std::size_t i = k; i < raw.size(); i += kChannels, scan += 1.0)
    weighted += (scan - middle) * (raw[i] - mean_lsb);
  return n < 2.0 ? 0.0 : weighted / (n * (n * n - 1.0) / 12.0) * n;
}

int LongestRun(Raw raw, std::size_t k) {
  int run = 1, longest = 1;
  for (std::size_t i = k + kChannels; i < raw.size(); i += kChannels) {
    run = raw[i] == raw[i - kChannels] ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

ChannelView Look(Raw raw, std::size_t k, int bits) {
  const CodeMoments moments = MomentsOf(raw, kChannels, static_cast<int>(k));
  const ChannelBlock block = StatisticsOf(moments, 1.0);
  const std::int64_t end = std::int64_t{1} << (bits - 1);
  return {.mean_lsb = block.mean_V,
          .std_lsb = moments.n < 2 ? 0.0 : block.std_V,
          .noise_lsb = NeighbourNoise_lsb(raw, k),
          .drift_lsb = Drift_lsb(raw, k, block.mean_V),
          .longest_run = LongestRun(raw, k),
          .saturated = moments.lowest <= -end || moments.highest >= end - 1};
}

// --- all of them ---

using Views = std::array<ChannelView, kChannels>;

PerChannel Each(const Views& views, double ChannelView::*member) {
  PerChannel values;
  for (std::size_t k = 0; k < kChannels; ++k) values[k] = views[k].*member;
  return values;
}

/// Probability, at most, that noise leaves a run as long.
double RunProbability(int run, double scans, double noise_lsb) {
  const double one_code = std::erf(1.0 / (noise_lsb * std::sqrt(8.0)));
  return scans * std::pow(one_code, run - 1.0);
}

/// 0: not known. Two codes in turn look like noise of 0.7 codes, however little there is.
double ExpectedNoise_lsb(const Views& views, const CheckSettings& settings) {
  if (settings.noise_lsb > 0.0) return settings.noise_lsb;
  const double others_lsb = SecondSmallest(Each(views, &ChannelView::noise_lsb));
  return others_lsb > 1.0 ? others_lsb : 0.0;
}

int StuckMask(const Views& views, double scans, double expected_lsb, const CheckSettings& settings) {
  int mask = 0;
  if (expected_lsb <= 0.0) return mask;
  for (std::size_t k = 0; k < kChannels; ++k) {
    if (views[k].saturated) continue;
    const double probability = kChannels * RunProbability(views[k].longest_run, scans, 0.5 * expected_lsb);
    if (probability < settings.false_alarms) mask |= 1 << k;
  }
  return mask;
}

bool IsNearRail(const ChannelView& view, int bits) {
  return std::abs(view.mean_lsb) > 0.75 * std::ldexp(1.0, bits - 1);
}

bool Drifts(const ChannelView& view, int bits) {
  return std::abs(view.drift_lsb) > 0.01 * std::ldexp(1.0, bits - 1);
}

/// An open input does not show its amplifier's noise, and shows what it picks up.
int FloatingMask(const Views& views, const PerChannel& mains_lsb, double scans, double expected_lsb,
                 const CheckSettings& settings) {
  constexpr double kFarAbove = 5.0, kFarBelow = 0.25, kEnoughScans = 30.0;
  int mask = 0;
  if (scans < kEnoughScans) return mask;
  const double usual =
      std::max({SecondSmallest(Each(views, &ChannelView::std_lsb)), expected_lsb, kRoundingNoise_lsb});
  // Noise shows as an amplitude too.
  const double usual_mains = SecondSmallest(mains_lsb) + 10.0 * usual * std::sqrt(2.0 / scans);
  for (std::size_t k = 0; k < kChannels; ++k) {
    const ChannelView& view = views[k];
    const bool other_noise = view.std_lsb > kFarAbove * usual || view.noise_lsb < kFarBelow * expected_lsb;
    const bool hums = mains_lsb[k] > kFarAbove * usual_mains && Drifts(view, settings.bits);
    const bool open = (other_noise && IsNearRail(view, settings.bits)) || hums;
    const bool moves = view.std_lsb > 1.0;  // otherwise it is stuck
    if (open && moves && !view.saturated) mask |= 1 << k;
  }
  return mask;
}

}  // namespace

double UsualNoise_lsb(std::array<double, kChannels> noise_lsb) {
  std::sort(noise_lsb.begin(), noise_lsb.end());
  return std::max(0.5 * (noise_lsb[1] + noise_lsb[2]), kRoundingNoise_lsb);
}

BlockFindings CheckBlock(std::span<const std::int16_t> raw, const CheckSettings& settings) {
  Require(raw.size() >= kChannels && raw.size() % kChannels == 0, "a block has whole scans");
  Views views;
  for (std::size_t k = 0; k < kChannels; ++k) views[k] = Look(raw, k, settings.bits);
  BlockFindings found;
  for (std::size_t k = 0; k < kChannels; ++k) found.saturated_mask |= views[k].saturated ? 1 << k : 0;
  found.noise_lsb = Each(views, &ChannelView::noise_lsb);
  found.mains_lsb = MainsAmplitudes_lsb(raw, settings.scan_rate_Hz, settings.mains_Hz);
  const double expected_lsb = ExpectedNoise_lsb(views, settings);
  found.floating_mask = FloatingMask(views, found.mains_lsb, ScansIn(raw), expected_lsb, settings);
  found.stuck_mask = StuckMask(views, ScansIn(raw), expected_lsb, settings) & ~found.floating_mask;
  found.slip = FindChannelSlip(raw, settings.scan_order, UsualNoise_lsb(found.noise_lsb), settings.false_alarms);
  return found;
}

std::string ChannelsIn(int mask) {
  std::string names;
  for (int k = 0; k < kChannels; ++k) {
    if ((mask >> k & 1) == 0) continue;
    names += (names.empty() ? "" : " and ") + std::string(kChannelNames[static_cast<std::size_t>(k)]);
  }
  return names;
}

}  // namespace twinbench::hw
