#include "hw_bridge/ad/backoff.h"

#include <algorithm>
#include <thread>

namespace twinbench::hw {

void Backoff::BeforeAttempt() {
  constexpr std::chrono::milliseconds kFirst(50);
  constexpr int kDoublings = 5;
  if (failures_ > 0) std::this_thread::sleep_for(kFirst * (1 << std::min(failures_ - 1, kDoublings)));
  ++failures_;
}

}  // namespace twinbench::hw
