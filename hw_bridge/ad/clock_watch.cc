#include "hw_bridge/ad/clock_watch.h"

#include <cmath>
#include <string>
#include <utility>

#include "twin/core/device_fault.h"

namespace twinbench::hw {

void ClockWatch::Compare(std::int64_t card_ns, Time bench, Duration latency) {
  const bool compares = std::exchange(known_, true) && bench >= last_.bench;  // else the bench has begun anew
  const Meeting before = std::exchange(last_, {card_ns, bench, latency});
  const double card_s = static_cast<double>(card_ns - before.card_ns) * 1e-9,
               bench_s = ToSeconds(bench - before.bench);
  const double allowed_s = 1e-4 * bench_s + ToSeconds(before.latency + latency) + 1e-3;
  if (!compares) first_ = last_;
  if (compares && std::abs(card_s - bench_s) > allowed_s) {
    first_ = last_;
    throw DeviceFault(FaultKind::kClock, "adc",
                      "since the block before " + std::to_string(card_s) + " s have passed on the card and " +
                          std::to_string(bench_s) + " s on the bench");
  }
}

ClockWatch::Drift ClockWatch::DriftSoFar() const {
  const double bench_s = ToSeconds(last_.bench - first_.bench);
  if (!known_ || bench_s <= 0.0) return {};
  const double card_s = static_cast<double>(last_.card_ns - first_.card_ns) * 1e-9;
  const double latencies_s = std::hypot(ToSeconds(first_.latency), ToSeconds(last_.latency));
  return {1e6 * (card_s - bench_s) / bench_s, 1e6 * latencies_s / std::sqrt(12.0) / bench_s};
}

}  // namespace twinbench::hw
