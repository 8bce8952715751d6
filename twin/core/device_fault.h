#pragma once

#include <string>

#include "twin/core/errors.h"

namespace twinbench {

/// What went wrong with a device. The order is that of kFaultNames.
enum class FaultKind {
  kTimeout,       // no answer within the deadline
  kDropped,       // the connection ended, or a stream stopped in the middle
  kProtocol,      // an answer that is none: half a number, another question's
  kRefused,       // the device said no
  kIdentity,      // not the device that the bench file names
  kRestarted,     // it lost its origin or its settings since it was last asked
  kGap,           // scans are missing in a block
  kOverrun,       // a FIFO or ring ran full and the acquisition ended
  kChannelSlip,   // a lost word turned the order of the channels
  kStuck,         // a channel without noise
  kSignalLost,    // a channel that is not connected
  kStalled,       // a table that does not get on
  kFollowing,     // encoder and command are further apart than allowed
  kNotInPosition, // the move is over and the table is not there
  kMoved,         // it did not stand at its stop while a reading was taken
  kLimit,         // outside the limits, or on a switch
  kImplausible,   // an angle or voltage that cannot be
  kChanged,       // the bench is another than it was for readings that are kept: no run goes on behind them
  kClock,         // clocks of computer and device part
  kDisk,          // the record cannot be kept safe
  kStopped        // the operator said stop
};
inline constexpr int kFaultKinds = 21;
const char* FaultName(FaultKind kind);  // "timeout", "dropped", "channel_slip", ...

/// A device failed in a way that has a name. What to do about it is the procedure's business.
class DeviceFault : public BenchError {
 public:
  DeviceFault(FaultKind kind, const std::string& device, const std::string& what)
      : BenchError(device + ": " + what), kind_(kind), device_(device) {}
  FaultKind kind() const { return kind_; }
  const std::string& device() const { return device_; }

 private:
  FaultKind kind_;
  std::string device_;
};

}  // namespace twinbench
