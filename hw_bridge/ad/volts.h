#pragma once

#include <cstdint>
#include <span>

#include "hw_bridge/ad/ad_source.h"
#include "twin/core/devices.h"

namespace twinbench::hw {

double VoltsOf(double code, const CalibrationPolynomial& calibration);

/// Mean, sample standard deviation (n - 1; NaN for one sample) and extremes of one channel, every code by itself
/// through its polynomial.
/// @param raw  Scans x kChannels; at least one scan.
ChannelBlock CalibratedStatistics(std::span<const std::int16_t> raw, std::size_t channel,
                                  const CalibrationPolynomial& calibration);

}  // namespace twinbench::hw
