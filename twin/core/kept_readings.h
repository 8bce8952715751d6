#pragma once

#include <vector>

#include "twin/core/devices.h"
#include "twin/core/reading.h"

namespace twinbench {

/// The readings of one run of thousands: neither what was asked of devices nor samples, and nothing on a disk.
class KeptReadings : public ReadingSink {
 public:
  void Append(const Reading& reading, const Acquisition& block) override;
  /// As RunRecord::Readings of the same run, to the same bits.
  std::vector<Reading> Take() { return std::move(readings_); }

 private:
  std::vector<Reading> readings_;
};

}  // namespace twinbench
