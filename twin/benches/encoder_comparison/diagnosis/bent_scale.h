#pragma once

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose::encoder {

/// Of a scale that bends, whose ratio is that at 0 and may have the other sign there: a note of its mean over the readings, the
/// slope of the straight line that is nearest to what it shows.
void TellMeanRatio(DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
