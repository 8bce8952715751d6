#include "twin/core/device_fault.h"

#include <array>

namespace twinbench {

const char* FaultName(FaultKind kind) {
  static constexpr std::array<const char*, kFaultKinds> kFaultNames = {
      "timeout", "dropped",      "protocol", "refused",     "identity", "restarted", "gap",
      "overrun", "channel_slip", "stuck",    "signal_lost", "stalled",  "following", "not_in_position",
      "moved",   "limit",        "implausible", "changed",  "clock",    "disk",     "stopped"};
  return kFaultNames[static_cast<std::size_t>(kind)];
}

}  // namespace twinbench
