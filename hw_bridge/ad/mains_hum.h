#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "twin/core/reading.h"

namespace twinbench::hw {

/// Amplitude [codes] of the mains in each channel, by least squares of mean, sine and cosine; NaN if the block is
/// shorter than a period, where it cannot be told from drift. Noise of s codes in n scans alone shows as s sqrt(pi
/// / n).
/// @param raw  Scans x kChannels.
std::array<double, kChannels> MainsAmplitudes_lsb(std::span<const std::int16_t> raw, double scan_rate_Hz,
                                                  double mains_Hz);

}  // namespace twinbench::hw
