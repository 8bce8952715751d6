#pragma once

#include "twin/core/run_record.h"

namespace twinbench::test {

/// A reading, a block and calls that follow from a number, so that what comes back can be checked.
inline Reading NumberedReading(int number) {
  Reading reading;
  reading.reading = number;
  reading.time = Time(std::chrono::milliseconds(7 * number));
  reading.target_rad = 0.01 * number;
  reading.reference_rad = -0.01 * number;
  for (std::size_t c = 0; c < kChannels; ++c) reading.mean_V[c] = 0.001 * number + static_cast<double>(c);
  reading.n_samples = 3000;
  return reading;
}

inline Acquisition NumberedBlock(int number) {
  Acquisition block;
  block.raw.assign(12000, static_cast<std::int16_t>(number));  // 24 kB: a run passes a checkpoint of the log
  return block;
}

}  // namespace twinbench::test
