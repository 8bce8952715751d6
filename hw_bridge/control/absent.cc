#include "hw_bridge/control/absent.h"

#include "twin/core/device_fault.h"

namespace twinbench::hw {

AutocollimatorReading NoAutocollimator::Read() {
  throw DeviceFault(FaultKind::kRefused, "autocollimator",
                    "the bench file has none; calibration and verification need one");
}

void NoGoniometer::MoveTo(double, double) {
  throw DeviceFault(FaultKind::kRefused, "goniometer",
                    "the bench file has none; calibration and verification need one");
}

}  // namespace twinbench::hw
