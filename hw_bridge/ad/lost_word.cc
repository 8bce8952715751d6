#include "hw_bridge/ad/lost_word.h"

#include <algorithm>
#include <cmath>

#include "hw_bridge/ad/channel_slip.h"

namespace twinbench::hw {

LostWord IfAWordWereLost(const std::array<double, kChannels>& level_lsb,
                         const std::array<std::size_t, kChannels>& scan_order, double noise_lsb, int scans,
                         double false_alarms) {
  double squares_lsb = 0.0, largest_lsb = 0.0;
  for (std::size_t place = 0; place < kChannels; ++place) {
    const double difference_lsb = level_lsb[scan_order[(place + 1) % kChannels]] - level_lsb[scan_order[place]];
    squares_lsb += difference_lsb * difference_lsb;
    largest_lsb = std::max(largest_lsb, std::abs(difference_lsb));
  }
  const double gain = 0.25 * scans * squares_lsb / (noise_lsb * noise_lsb);
  const bool stands_out = 0.25 * gain - 3.0 * std::sqrt(gain) > NeededForSlip(scans, false_alarms);
  return {stands_out && largest_lsb >= kLeastSlip_lsb, 0.5 * largest_lsb};
}

}  // namespace twinbench::hw
