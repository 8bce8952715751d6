#include "hw_bridge/serve/watchdog.h"

#include <algorithm>

namespace twinbench::hw {

void Watchdog::Arm(const void* who, WallClock::duration patience) {
  if (patience > WallClock::duration::zero()) {
    armed_[who] = patience;
  } else {
    armed_.erase(who);
  }
  heard_ = wall_();
  told_ = false;
}

WallClock::duration Watchdog::PatienceOf(const void* who) const {
  const auto found = armed_.find(who);
  return found == armed_.end() ? WallClock::duration::zero() : found->second;
}

void Watchdog::Hear(const void* who) {
  if (!armed_.contains(who)) return;
  heard_ = wall_();
  told_ = false;
}

bool Watchdog::IsMissingThem() {
  if (armed_.empty() || told_) return false;
  const auto shortest = std::ranges::min_element(armed_, {}, [](const auto& client) { return client.second; })->second;
  told_ = wall_() - heard_ > shortest;
  return told_;
}

}  // namespace twinbench::hw
