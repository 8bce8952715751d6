#include "hw_bridge/control/allowed_motion.h"

#include <fmt/format.h>

namespace twinbench::hw {
namespace {

std::string InWords(const MachineAxis& axis, const AllowedMotion& allowed) {
  const double to_SI = axis.to_SI();
  const std::string travel =
      fmt::format("{:.6f} to {:.6f} {}", allowed.lower / to_SI, allowed.upper / to_SI, axis.unit());
  return allowed.fastest ? fmt::format("{} at up to {:.6g} {}/s", travel, *allowed.fastest / to_SI, axis.unit())
                         : travel;
}

}  // namespace

void RequireAsAgreed(const DeviceLine& line, const MachineAxis& axis, const AllowedMotion& agreed,
                     const AllowedMotion& now) {
  if (now == agreed) return;
  line.Fail(FaultKind::kMoved,
            fmt::format("the controller allowed axis {} {} and now allows {}: somebody else set its limits",
                        axis.name, InWords(axis, agreed), InWords(axis, now)));
}

}  // namespace twinbench::hw
