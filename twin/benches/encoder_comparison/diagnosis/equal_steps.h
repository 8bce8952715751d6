#pragma once

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose::encoder {

/// Slips of one size, to either side, and others that are multiples of it, are one thing that happened several
/// times: counts that were lost or came. No cause of the catalogue is that, so that they become one structure
/// without a name, told with its size and where it happened; what was fitted stays as it is.
void TellEqualSteps(DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
