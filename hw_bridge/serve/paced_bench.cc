#include "hw_bridge/serve/paced_bench.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace twinbench::hw {
namespace {

constexpr double kBlock_s = 4e-3;  // of wall time, of the running converter
constexpr double kMostScans = 65536.0;

int BlockScans(const AdcSettings& adc, double speed) {
  const double scans = kBlock_s * std::min(speed, 1e3) * adc.rate_Hz / kChannels;
  return static_cast<int>(std::clamp(scans, 1.0, kMostScans));
}

}  // namespace

PacedBench::PacedBench(RotaryBench bench, const AdcSettings& adc, double speed, Wall wall)
    : PacedClock(bench.clock, bench.simulation, speed, std::move(wall)),
      bench_(bench),
      stream_(bench.adc, bench.clock, adc, BlockScans(adc, std::isfinite(speed) ? speed : 1.0)) {}

/// With readers time passes in whole blocks. What nobody can have any more is not converted.
void PacedBench::Follow(Duration behind) {
  if (readers_ == 0) return PacedClock::Follow(behind);
  if (const Duration missed = behind - stream_.HeldAtMost(); missed > stream_.BlockTime()) {
    stream_.Miss(missed);
    Book(missed);
    behind -= missed;
  }
  for (; behind >= stream_.BlockTime(); behind -= stream_.BlockTime()) {
    stream_.TakeNext();
    Book(stream_.BlockTime());
  }
}

}  // namespace twinbench::hw
