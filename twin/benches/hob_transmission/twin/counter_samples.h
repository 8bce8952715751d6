#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/time.h"

namespace twinbench {

/// Both counters of a hobbing machine at one edge of the table's encoder.
struct CounterSample {
  Time time{};
  double table_encoder_rad = kNaN;  // unwrapped since the mounting
  double hob_encoder_rad = kNaN;
  double velocity_rad_s = kNaN;  // of the table, as the drive was told
  double interferometer_rad = kNaN;
};

/// What a counter card's FIFO held.
struct CounterSamples {
  std::vector<CounterSample> samples;  // in order
  bool overrun = false;                // it ran full: samples behind these are lost
};

}  // namespace twinbench
