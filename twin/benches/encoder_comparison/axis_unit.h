#pragma once

#include <string>

#include "twin/benches/encoder_comparison/settings.h"

namespace twinbench::benches::encoder {

/// What values are told in.
struct AxisUnit {
  std::string name;    // "deg"
  double to_SI = 1.0;  // factor to the bench's rad
};

/// "deg", or "mm" of a linear axis.
inline AxisUnit CoarseUnit(const DeviceSettings& device) {
  if (device.turn_m > 0.0) return {"mm", units::turn / device.turn_m * units::mm};
  return {"deg", units::deg};
}

/// "arcsec", or "um" of a linear axis.
inline AxisUnit FineUnit(const DeviceSettings& device) {
  if (device.turn_m > 0.0) return {"um", units::turn / device.turn_m * units::um};
  return {"arcsec", units::arcsec};
}

}  // namespace twinbench::benches::encoder
