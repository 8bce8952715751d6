#include "hw_bridge/ad/clock_watch.h"

#include <cmath>
#include <string>
#include <utility>

#include "twin/core/device_fault.h"

namespace twinbench::hw {

void ClockWatch::Compare(std::int64_t card_ns, Time bench, Duration latency) {
  const bool compares = std::exchange(known_, false);
  const double card_s = static_cast<double>(card_ns - card_ns_) * 1e-9, bench_s = ToSeconds(bench - bench_);
  const double allowed_s = 1e-4 * std::abs(bench_s) + ToSeconds(latency_ + latency) + 1e-3;
  if (compares && std::abs(card_s - bench_s) > allowed_s) {
    throw DeviceFault(FaultKind::kClock, "adc",
                      "since the block before " + std::to_string(card_s) + " s have passed on the card and " +
                          std::to_string(bench_s) + " s on the bench");
  }
  known_ = true;
  card_ns_ = card_ns;
  bench_ = bench;
  latency_ = latency;
}

}  // namespace twinbench::hw
