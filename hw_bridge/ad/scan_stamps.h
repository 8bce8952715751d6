#pragma once

#include <cstdint>
#include <span>

namespace twinbench::hw {

/// What the time stamps of a block say about its scans.
struct StampFindings {
  std::int64_t lost_scans = 0;
  std::int64_t first_gap = -1;   // scan in front of which the first ones are missing
  std::int64_t first_back = -1;  // scan whose stamp is not later than the one before
};

/// Looks at every step from stamp to stamp. One that is off by half a scan period or more is a gap of the nearest
/// whole number of periods: neither jitter nor a clock that is some ppm off can do that, since only single steps
/// are judged.
/// @param stamps_ns     One a scan.
/// @param scan_rate_Hz  Positive.
StampFindings JudgeStamps(std::span<const std::int64_t> stamps_ns, double scan_rate_Hz);

}  // namespace twinbench::hw
