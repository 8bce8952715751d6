#include "hw_bridge/clock_notices.h"

#include <fmt/core.h>

#include <cstdio>

#include "hw_bridge/control/host_clock.h"

namespace twinbench::hw {

void ClockNotices::Tell(const std::string& notice) const {
  fmt::print(stderr, "twinbench: {}\n", notice);
  if (listener) listener(notice);
}

std::unique_ptr<Clock> OpenHostClock(Duration elapsed, const ClockNotices& notices, const std::function<bool()>& stop_asked) {
  auto clock = std::make_unique<HostClock>(elapsed, [&notices](const std::string& notice) { notices.Tell(notice); });
  clock->HearStop(stop_asked);
  return clock;
}

}  // namespace twinbench::hw
