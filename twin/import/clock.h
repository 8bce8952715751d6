#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Clocks as files write them down.
namespace twinbench::imports {

/// Seconds since 1970 (UTC as written; a zone's offset is taken off) of "2021-10-27 09:04:48.529",
/// "2021-10-27T09:04:48Z", "27.10.2021 09:04:48,529", "10/27/2021 9:04:48 AM"; seconds since midnight of a time
/// alone, "09:04:48.529".
struct Instant {
  double time_s = 0.0;
  bool has_date = false;
};
std::optional<Instant> ParseInstant(std::string_view text);

/// What numbers of a time column count.
struct NumberClock {
  std::string words;  // "Windows file time, 100 ns since 1601"
  double to_s = 1.0;
  double origin = 0.0;  // in the numbers' own count: that of 1970
  bool absolute = false;
};

/// @param unit  As the file or the map has it: "s", "ms", "epoch", "filetime"; empty: found by the size of the
/// numbers,
///              seconds where they are small.
/// @return nothing if there is no such unit of time.
std::optional<NumberClock> ClockOf(const std::vector<double>& numbers, const std::string& unit);

}  // namespace twinbench::imports
