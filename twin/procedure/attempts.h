#pragma once

#include "twin/core/device_fault.h"
#include "twin/core/run_log.h"

namespace twinbench::procedure {

/// Whether the same again may end otherwise without a hand at the bench.
bool IsWorthAnotherAttempt(FaultKind kind);

/// Counts the attempts at the reading that is next.
class Attempts {
 public:
  explicit Attempts(int allowed) : allowed_(allowed) {}
  bool AnotherAt(int reading);

 private:
  int allowed_, reading_ = -1, failed_ = 0;
};

/// @param log  None: nothing is written down.
void NoteFailure(RunLog* log, int reading, Time now, const DeviceFault& fault);

}  // namespace twinbench::procedure
