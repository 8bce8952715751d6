#pragma once

#include <span>

#include "twin/core/reading.h"

namespace twinbench {

/// The extra column by which a list that nobody timed says so, and its only value.
inline constexpr const char* kClockColumn = "clock";
inline constexpr const char* kNoClock = "none";

/// False of readings from a list without a clock, as `import` marks them: their times count the rows, and no duration,
/// rate or frequency can be told from them; their order is all that is known.
bool HasClock(std::span<const Reading> readings);

}  // namespace twinbench
