#pragma once

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose::encoder {

/// Over a part of a turn a few waves are whatever the axis has so many of a turn; many of them are the pieces of a
/// curve that any sum of waves comes close to. They become one structure without a name, told with its size; what
/// was fitted stays as it is.
void TellCurveInPieces(DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
