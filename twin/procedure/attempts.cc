#include "twin/procedure/attempts.h"

namespace twinbench::procedure {

bool IsWorthAnotherAttempt(FaultKind kind) {
  switch (kind) {
    case FaultKind::kTimeout:
    case FaultKind::kDropped:
    case FaultKind::kProtocol:
    case FaultKind::kRestarted:
    case FaultKind::kGap:
    case FaultKind::kOverrun:
    case FaultKind::kChannelSlip:
    case FaultKind::kStuck:
    case FaultKind::kNotInPosition:
    case FaultKind::kMoved:
    case FaultKind::kClock:
      return true;
    case FaultKind::kRefused:
    case FaultKind::kIdentity:
    case FaultKind::kSignalLost:
    case FaultKind::kStalled:
    case FaultKind::kFollowing:
    case FaultKind::kLimit:
    case FaultKind::kImplausible:
    case FaultKind::kChanged:
    case FaultKind::kDisk:
    case FaultKind::kStopped:
      return false;
  }
  return false;
}

bool Attempts::AnotherAt(int reading) {
  failed_ = reading == reading_ ? failed_ + 1 : 1;
  reading_ = reading;
  return failed_ < allowed_;
}

void NoteFailure(RunLog* log, int reading, Time now, const DeviceFault& fault) {
  if (!log || fault.kind() == FaultKind::kDisk) return;  // there may be no room to say so
  log->AttemptFailed(reading, now, FaultName(fault.kind()), fault.what());
}

}  // namespace twinbench::procedure
