#include "twin/sim/setup_check.h"

#include <fmt/format.h>

#include "twin/core/device_fault.h"

namespace twinbench::sim {

void RequireSetup(int setup, int setups) {
  if (setup < 0 || setup >= setups)
    throw DeviceFault(FaultKind::kRefused, "fixture",
                      fmt::format("there are {} mountings, from 0 on; not {}", setups, setup));
}

}  // namespace twinbench::sim
