#pragma once

#include <string>
#include <utility>

#include "twin/core/device_fault.h"

namespace twinbench::procedure {

/// Whether what was told to stop stands, as controllers and encoders say.
struct Standstill {
  bool is_sure = false;
  std::string why_not;  // what moves, or why nobody knows
};

/// A fault that ended a run, and whether what it moved was at rest behind it.
class StoppedRun : public DeviceFault {
 public:
  StoppedRun(const DeviceFault& why, Standstill stands) : DeviceFault(why), stands_(std::move(stands)) {}
  const Standstill& stands() const { return stands_; }

 private:
  Standstill stands_;
};

}  // namespace twinbench::procedure
