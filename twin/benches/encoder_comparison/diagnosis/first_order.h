#pragma once

#include "twin/benches/encoder_comparison/diagnosis/signals.h"
#include "twin/diagnose/extend.h"

namespace twinbench::diagnose::encoder {

/// Over a part of a turn a scale and low orders together are what a scale off its axis shows alone: where one wave of order 1
/// leaves no more of the readings than they do, each of them may be no more than that, and the whole turn would tell.
void TellOrFirstOrder(const SignalContext& context, DiagnosisRun& result);

/// An order that the run goes through less than twice is no more than a curve where a polynomial does as well by Schwarz's
/// criterion, beside the memory of what is left: it has not been seen to repeat, and any other order near it may be it.
void TellOrCurve(const SignalContext& context, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
