#pragma once

#include <thread>

#include "twin/core/device_fault.h"

namespace twinbench::tools {

/// While it lives, whoever stands at the bench is told within a second that a device does not answer, once for each device's
/// silence.
class LinkWatch {
 public:
  LinkWatch();

 private:
  std::jthread watch_;
};

/// Tells on stderr of a fault before anything is done about it.
void TellFault(const DeviceFault& fault);

}  // namespace twinbench::tools
