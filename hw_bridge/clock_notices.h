#pragma once

#include <functional>
#include <memory>
#include <string>

#include "twin/core/devices.h"

namespace twinbench::hw {

/// Where what a computer's clocks do is told: to the operator, and to who listens, that it is recorded.
struct ClockNotices {
  std::function<void(const std::string&)> listener = {};
  void Tell(const std::string& notice) const;
};

/// The computer's clock, which tells there and hears a stop while it waits.
/// @param notices  Outlives it.
std::unique_ptr<Clock> OpenHostClock(Duration elapsed, const ClockNotices& notices, const std::function<bool()>& stop_asked);

}  // namespace twinbench::hw
