#pragma once

#include <array>

#include "twin/core/reading.h"

namespace twinbench::hw {

/// What a word that a card loses half-way through a block would do to it.
struct LostWord {
  bool shows = true;       // FindChannelSlip is as good as sure to see it (3 standard deviations)
  double shift_lsb = 0.0;  // of the mean of the channel that it would hit hardest
};

/// A lost word is seen by the channels' levels alone. Behind it every place of the scan shows the level of the
/// next, which takes D = n/4 sum(difference^2) / noise^2 off the sum of squares over the noise, of which a ramp
/// through the block would take 3/4: D/4 - 3 sqrt(D) must exceed what FindChannelSlip asks for. Levels that lie
/// closer together hide it.
///
/// @param level_lsb   Of each channel, mean of the block.
/// @param scan_order  Channel of each place in the scan.
/// @param noise_lsb   Standard deviation of one sample; not less than that of rounding.
LostWord IfAWordWereLost(const std::array<double, kChannels>& level_lsb,
                         const std::array<std::size_t, kChannels>& scan_order, double noise_lsb, int scans,
                         double false_alarms);

}  // namespace twinbench::hw
