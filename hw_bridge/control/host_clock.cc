#include "hw_bridge/control/host_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "twin/core/device_fault.h"

namespace twinbench::hw {
namespace {

constexpr Duration kWorthTelling = std::chrono::milliseconds(500);
constexpr Duration kHearsStop = std::chrono::milliseconds(50);

template <class ClockType>
std::int64_t ReadClock_ns() {
  return std::chrono::duration_cast<Duration>(ClockType::now().time_since_epoch()).count();
}

}  // namespace

HostClock::HostClock(Duration elapsed, Notice notice)
    : HostClock(elapsed, std::move(notice), ReadClock_ns<std::chrono::steady_clock>,
                ReadClock_ns<std::chrono::system_clock>,
                [](Duration duration) { std::this_thread::sleep_for(duration); }) {}

HostClock::HostClock(Duration elapsed, Notice notice, Reading steady_ns, Reading utc_ns,
                     std::function<void(Duration)> wait)
    : notice_(std::move(notice)),
      steady_ns_(std::move(steady_ns)),
      utc_ns_(std::move(utc_ns)),
      wait_(std::move(wait)),
      origin_ns_(steady_ns_() - elapsed.count()),
      difference_ns_(utc_ns_() - steady_ns_()) {}

Time HostClock::Now() const {
  return Time(Duration(steady_ns_() - origin_ns_));
}

void HostClock::Wait(Duration duration) {
  const Time end = Now() + duration;
  for (Duration left = duration; left > Duration(0); left = end - Now()) {
    if (stop_asked_ && stop_asked_()) throw DeviceFault(FaultKind::kStopped, "operator", "the run was stopped");
    wait_(stop_asked_ ? std::min(left, kHearsStop) : left);
  }
  CompareClocks();
}

Duration HostClock::UtcStep() const {
  return Duration(utc_ns_() - steady_ns_() - difference_ns_);
}

void HostClock::CompareClocks() {
  const Duration step = UtcStep();
  if (std::chrono::abs(step - told_) < kWorthTelling) return;
  told_ = step;
  notice_(
      fmt::format("the computer's wall clock has gone {:+.3f} s against its steady clock; times of readings come "
                  "from the steady clock, only their UTC labels jump",
                  ToSeconds(step)));
}

}  // namespace twinbench::hw
