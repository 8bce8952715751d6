#include "twin/core/reading_clock.h"

#include <algorithm>

namespace twinbench {

bool HasClock(std::span<const Reading> readings) {
  return std::ranges::none_of(readings, [](const Reading& reading) {
    const auto clock = reading.extra.find(kClockColumn);
    return clock != reading.extra.end() && clock->second == kNoClock;
  });
}

}  // namespace twinbench
