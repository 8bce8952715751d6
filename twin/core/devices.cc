#include "twin/core/devices.h"

#include "twin/core/device_fault.h"

namespace twinbench {

void RotaryTable::WaitSettled() {
  constexpr int kLimit_s = 60;
  for (int second = 0; second < kLimit_s; ++second) {
    if (Settles(std::chrono::seconds(1))) return;
  }
  throw DeviceFault(FaultKind::kNotInPosition, "table",
                    "not in position after 60 s; is the servo stable with this payload?");
}

}  // namespace twinbench
