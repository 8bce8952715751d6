#pragma once

#include <functional>
#include <string>

#include "twin/core/devices.h"

namespace twinbench::hw {

/// The computer's steady clock, for a bench without one. The wall clock is a label that may jump: it is only
/// watched, and who listens is told when it has parted from the steady clock by another half second.
class HostClock : public Clock {
 public:
  using Notice = std::function<void(const std::string&)>;
  using Reading = std::function<std::int64_t()>;  // ns

  /// @param elapsed  Time 0 was so long ago.
  explicit HostClock(Duration elapsed, Notice notice);
  /// With other clocks than the computer's; `wait` passes time.
  HostClock(Duration elapsed, Notice notice, Reading steady_ns, Reading utc_ns, std::function<void(Duration)> wait);

  /// From here on Wait asks `stop_asked` every 50 ms, and ends with a DeviceFault kStopped where it says so: an axis may be turning
  /// meanwhile.
  void HearStop(std::function<bool()> stop_asked) { stop_asked_ = std::move(stop_asked); }

  Time Now() const override;
  void Wait(Duration duration) override;
  /// How far the wall clock has gone ahead of the steady one since the start.
  Duration UtcStep() const;

 private:
  void CompareClocks();

  Notice notice_;
  Reading steady_ns_, utc_ns_;
  std::function<void(Duration)> wait_;
  std::function<bool()> stop_asked_;
  std::int64_t origin_ns_;      // of Time 0, on the steady clock
  std::int64_t difference_ns_;  // utc - steady at the start
  Duration told_{};
};

}  // namespace twinbench::hw
