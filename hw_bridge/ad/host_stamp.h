#pragma once

#include "twin/core/devices.h"

namespace twinbench::hw {

/// What the computer's clocks show now; the converter's own count and time are not known.
BlockStamp HostStamp();

}  // namespace twinbench::hw
