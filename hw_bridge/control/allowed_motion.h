#pragma once

#include <optional>

#include "hw_bridge/control/device_line.h"
#include "twin/core/machine.h"

namespace twinbench::hw {

/// What a controller allows an axis [m, rad, and a second].
struct AllowedMotion {
  double lower = kNaN, upper = kNaN;
  std::optional<double> fastest = {};  // none: it does not tell
  bool operator==(const AllowedMotion&) const = default;
};

/// @throws DeviceFault kMoved if a controller allows an axis something else than when limits were agreed on.
void RequireAsAgreed(const DeviceLine& line, const MachineAxis& axis, const AllowedMotion& agreed,
                     const AllowedMotion& now);

}  // namespace twinbench::hw
