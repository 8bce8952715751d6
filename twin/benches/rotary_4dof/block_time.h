#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/shared_settings.h"
#include "twin/core/time.h"

/// A reading of the rotary bench is the mean of a block of the A/D converter: it tells of the middle of the block,
/// and `time_s` is its begin.
namespace twinbench {

inline Duration BlockTime(const AdcSettings& adc, int n_samples) {
  return FromSeconds(static_cast<double>(n_samples) * kChannels / adc.rate_Hz);
}

/// Scans of its block; those of the scenario where the record does not say.
inline int SamplesOf(const Reading& reading, const AdcSettings& adc) {
  return reading.n_samples > 0 ? reading.n_samples : adc.samples;
}

inline std::vector<Reading> AtMiddleOfBlocks(std::vector<Reading> readings, const AdcSettings& adc) {
  for (Reading& reading : readings) reading.time += BlockTime(adc, SamplesOf(reading, adc)) / 2;
  return readings;
}

}  // namespace twinbench
