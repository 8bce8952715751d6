#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "hw_bridge/ad/channel_slip.h"
#include "twin/core/reading.h"

/// What can be told from the codes of a block alone. Nothing here knows a driver; a finding is a result, and what
/// to do about it is the caller's business.
namespace twinbench::hw {

struct CheckSettings {
  int bits = 16;
  double scan_rate_Hz = 62.5e3;
  std::array<std::size_t, kChannels> scan_order = {0, 1, 2, 3};  // channel of each place in the scan
  double mains_Hz = 50.0;
  double noise_lsb = 0.0;      // expected of one sample; 0: not known
  double false_alarms = 1e-9;  // of each check, a block
};

struct BlockFindings {
  int saturated_mask = 0;  // bit k: some code of channel k is an end code
  int stuck_mask = 0;      // one code for longer than noise would leave it
  int floating_mask = 0;   // not connected
  ChannelSlip slip;
  std::array<double, kChannels> noise_lsb{};  // from differences of neighbouring scans: without drift and hum
  std::array<double, kChannels> mains_lsb{};  // amplitude; NaN in blocks shorter than a period
};

/// Noise that the channels have in common, for the slip: the median, and never less than rounding alone makes.
double UsualNoise_lsb(std::array<double, kChannels> noise_lsb);

/// Stuck: the longest run of r equal codes among n. Noise of s codes leaves one code with at most p = erf(1 / (s
/// sqrt 8)), so n p^(r-1) bounds the probability of such a run; s is half of the least to expect, which is the
/// expected noise or, if that is not known, that of the channel with the second smallest, where over 1 code.
/// Channels at an end code are saturated instead.
///
/// Floating: the level is beyond 3/4 of the range, and the standard deviation over 5 times that of the others or
/// the noise from scan to scan under a quarter of what is expected; or mains and drift are far above the others'.
/// "The others" are those up to the second smallest, so that both channels of a PSD may be off. Needs 30 scans. A
/// clipped channel is saturated instead.
///
/// Slip: see channel_slip.h.
///
/// @param raw  Scans x kChannels, two's complement; at least one scan.
BlockFindings CheckBlock(std::span<const std::int16_t> raw, const CheckSettings& settings);

/// "psd_a_x and psd_b_y"; for messages.
std::string ChannelsIn(int mask);

}  // namespace twinbench::hw
