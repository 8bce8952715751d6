#include "hw_bridge/ad/scan_stamps.h"

#include <cmath>

namespace twinbench::hw {

StampFindings JudgeStamps(std::span<const std::int64_t> stamps_ns, double scan_rate_Hz) {
  StampFindings found;
  for (std::size_t scan = 1; scan < stamps_ns.size(); ++scan) {
    const auto step_ns = static_cast<double>(stamps_ns[scan] - stamps_ns[scan - 1]);
    const double periods = step_ns * 1e-9 * scan_rate_Hz;
    if (std::abs(periods - 1.0) < 0.5) continue;
    const auto at = static_cast<std::int64_t>(scan);
    if (periods < 1.0) {
      if (found.first_back < 0) found.first_back = at;
    } else {
      if (found.first_gap < 0) found.first_gap = at;
      found.lost_scans += std::llround(periods) - 1;
    }
  }
  return found;
}

}  // namespace twinbench::hw
