#pragma once

#include <optional>
#include <string>

#include "twin/core/time.h"

/// How long ago a run began, told by a clock that nobody sets.
namespace twinbench {

/// What both clocks of a computer show at one moment.
struct ClockMark {
  std::string boot;           // names the time since the machine was started; empty: it has no such clock
  double since_boot_s = 0.0;  // sleep included
  double utc_s = 0.0;         // since 1970; people and time servers set it
};

ClockMark ClockMarkNow();

/// As text that keeps it, for a record's events; and back. Nothing: the text is none.
std::string TextOf(const ClockMark& mark);
std::optional<ClockMark> ParseClockMark(const std::string& text);

struct Elapsed {
  Duration time{};
  std::string note;  // what was wrong with a clock, in words; empty: nothing
};

/// From one moment to a later one: by the time since the machine was started, and where it was started anew by UTC,
/// which may have been set meanwhile. A difference of both of more than a second is noted.
Elapsed Between(const ClockMark& first, const ClockMark& later);

}  // namespace twinbench
