#pragma once

#include <iio.h>

#include <cstdint>
#include <string>
#include <vector>

#include "twin/core/time.h"

namespace twinbench::hw {

/// A device's channels as the bridge uses them.
struct IioChannels {
  std::string name;  // of the device, for messages
  iio_device* device = nullptr;
  std::vector<iio_channel*> channels;  // in the order asked for
  iio_channel* timestamp = nullptr;    // may be missing
};

struct IioBlock {
  std::vector<std::int16_t> raw;        // scans x channels, two's complement
  std::vector<std::int64_t> stamps_ns;  // one a scan; empty without `timestamp`
};

/// Number of significant bits if a code fits into 16, else 0.
int BitsOf(const iio_channel* channel);

/// Opens a buffer of `scans` scans, fills it once and closes it.
/// @throws DeviceFault kTimeout at the deadline, kDropped if fewer scans come, and the fault of any errno.
IioBlock TakeIioBlock(const IioChannels& from, int scans, Duration deadline);

}  // namespace twinbench::hw
