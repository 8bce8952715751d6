#pragma once

#include <string>

#include "twin/core/device_call.h"

namespace twinbench {

/// Keeps what happened on the way to the readings.
class RunLog {
 public:
  virtual ~RunLog() = default;
  /// A device was called. Kept together with the next reading, or not at all.
  virtual void Called(const DeviceCall& call) = 0;
  /// The calls since the last reading led to nothing.
  virtual void ForgetCalls() = 0;
  /// An attempt at a reading came to nothing; attempts of a reading count from 1 and are never used twice.
  virtual void AttemptFailed(int reading, Time time, const std::string& fault, const std::string& text) = 0;
  virtual void AppendEvent(Time time, const std::string& device, const std::string& text) = 0;
  /// @throws DeviceFault kDisk if the next readings might not find room.
  virtual void RequireRoom() = 0;
};

}  // namespace twinbench
