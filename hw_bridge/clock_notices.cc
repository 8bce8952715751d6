#include "hw_bridge/clock_notices.h"

#include <fmt/core.h>

#include <cstdio>

namespace twinbench::hw {

void ClockNotices::Tell(const std::string& notice) const {
  fmt::print(stderr, "twinbench: {}\n", notice);
  if (listener) listener(notice);
}

}  // namespace twinbench::hw
