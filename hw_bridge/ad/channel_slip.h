#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "twin/core/reading.h"

namespace twinbench::hw {

/// From `scan` on, each place of the scan shows what the one `places` behind it showed before.
struct ChannelSlip {
  int scan = -1;   // -1: none
  int places = 0;  // 1 .. channels - 1
};

/// What a turn must take off the sum of squares over the noise to be told from chance, in a block of so many scans.
double NeededForSlip(int scans, double false_alarms);
/// Means that differ by less are not told apart.
inline constexpr double kLeastSlip_lsb = 4.0;

/// Looks for words that were lost inside a block: a multiplexed card without channel tags goes on with the channels
/// turned.
///
/// Three descriptions of the block are held against each other by their sums of squares over the noise: no change
/// (a mean a channel), a change at a scan after which the means are those before turned by some places, and one
/// after which they are anything. What all channels have in common (hum, supply) is taken off first: a turn leaves
/// it as it is. A slip is reported if
/// - turned beats unchanged by 2 ln(scans * turns / false_alarms): for a given scan and turn the likelihood ratio of a
///   block without a change exceeds x with a probability below 1 / x, and there are scans * turns of them;
/// - turned beats a ramp of every channel by as much, so that drift is none;
/// - turned is as good as any change (chi-squared of 4), so that the step of one channel is none;
/// - means that differ by 4 codes or more are exchanged: what is less does no harm and could be a creeping code.
/// Where the levels are too alike for that a slip is not seen: IfAWordWereLost (lost_word.h) says where.
///
/// @param raw         Scans x kChannels.
/// @param scan_order  Channel of each place in the scan: words move by places.
/// @param noise_lsb   Standard deviation of one sample; not less than that of rounding.
ChannelSlip FindChannelSlip(std::span<const std::int16_t> raw, const std::array<std::size_t, kChannels>& scan_order,
                            double noise_lsb, double false_alarms);

}  // namespace twinbench::hw
