#pragma once

#include <functional>
#include <string>

namespace twinbench::hw {

/// Where what a computer's clocks do is told: to the operator, and to who listens, that it is recorded.
struct ClockNotices {
  std::function<void(const std::string&)> listener = {};
  void Tell(const std::string& notice) const;
};

}  // namespace twinbench::hw
