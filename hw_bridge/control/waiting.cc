#include "hw_bridge/control/waiting.h"

#include <chrono>
#include <mutex>

namespace twinbench::hw {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr auto kLate = std::chrono::milliseconds(500);

std::mutex mutex;
const std::string* awaited = nullptr;
SteadyClock::time_point due;

}  // namespace

Waiting::Waiting(const std::string& device, Duration beyond) {
  const std::lock_guard lock(mutex);
  awaited = &device;
  due = SteadyClock::now() + beyond;
}

Waiting::~Waiting() {
  const std::lock_guard lock(mutex);
  awaited = nullptr;
}

std::string Waiting::Overdue() {
  const std::lock_guard lock(mutex);
  return awaited && SteadyClock::now() > due + kLate ? *awaited : "";
}

}  // namespace twinbench::hw
