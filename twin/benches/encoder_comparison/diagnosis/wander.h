#pragma once

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose::encoder {

/// Noise whose memory is nearly as long as the run is no noise of readings: it is told as what it is, a random walk
/// without a name. A cause that such a walk may well be by chance is no surer than that.
void TellWander(DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
