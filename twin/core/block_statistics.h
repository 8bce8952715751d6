#pragma once

#include <cstdint>
#include <span>

#include "twin/core/devices.h"

namespace twinbench {

/// Exact sums over the codes of one channel, counted from any base code.
struct CodeMoments {
  std::int64_t n = 0;
  std::int64_t base = 0;                 // code
  std::int64_t deviation = 0;            // sum of (code - base)
  std::int64_t square = 0;               // sum of its squares
  std::int64_t lowest = 0, highest = 0;  // code
};

/// Mean, sample standard deviation (n - 1; NaN for one sample) and extremes in volts. The sums are integers and are
/// divided once, so whoever counted the same codes gets the same bits, whatever the base and the order.
ChannelBlock StatisticsOf(const CodeMoments& moments, double lsb_V);

/// The moments of channel `channel` of raw counts, scans x channels; from the first code as base.
/// @throws std::logic_error unless there is at least one whole scan.
CodeMoments MomentsOf(std::span<const std::int16_t> raw, int channels, int channel);

}  // namespace twinbench
