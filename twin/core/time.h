#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace twinbench {

/// Time is an integer count of nanoseconds, so that equal times are equal and sums are exact.
/// The epoch is the start of the run; a real bench stores the wall clock of that origin.
struct BenchClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<BenchClock>;
};
using Duration = BenchClock::duration;
using Time = BenchClock::time_point;

/// Rounds seconds to the nearest nanosecond.
inline Duration FromSeconds(double seconds_s) {
  return Duration(static_cast<std::int64_t>(std::llround(seconds_s * 1e9)));
}
inline double ToSeconds(Duration duration) { return static_cast<double>(duration.count()) * 1e-9; }
inline double ToSeconds(Time time) { return ToSeconds(time.time_since_epoch()); }

}  // namespace twinbench
