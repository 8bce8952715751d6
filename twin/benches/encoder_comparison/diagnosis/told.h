#pragma once

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"
#include "twin/benches/encoder_comparison/diagnosis/signals.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/extend.h"

/// What is said of the causes that were found, beside them or in their place.
namespace twinbench::diagnose::encoder {

/// Of a scale that bends, whose ratio is that at 0 and may have the other sign there: a note of its mean over the readings, the
/// slope of the straight line that is nearest to what it shows.
void TellMeanRatio(DiagnosisRun& result);

/// Over a part of a turn a scale and low orders together are what a scale off its axis shows alone: where one wave of order 1
/// leaves no more of the readings than they do, each of them may be no more than that, and the whole turn would tell.
void TellOrFirstOrder(const SignalContext& context, DiagnosisRun& result);

/// An order that the run goes through less than twice is no more than a curve where a polynomial does as well by Schwarz's
/// criterion, beside the memory of what is left: it has not been seen to repeat, and any other order near it may be it.
void TellOrCurve(const SignalContext& context, DiagnosisRun& result);

/// Of a latency: whether a lag of first order would leave nearly as much as the delay, or a delay as the lag. It is one
/// cause either way.
void TellOtherLag(const LargeCauses& large, Diagnosis& diagnosis);

/// Slips of one size, to either side, and others that are multiples of it, are one thing that happened several
/// times: counts that were lost or came. No cause of the catalogue is that, so that they become one structure
/// without a name, told with its size and where it happened; what was fitted stays as it is.
void TellEqualSteps(DiagnosisRun& result);

/// Over a part of a turn a few waves are whatever the axis has so many of a turn; many of them are the pieces of a
/// curve that any sum of waves comes close to. They become one structure without a name, told with its size; what
/// was fitted stays as it is.
void TellCurveInPieces(DiagnosisRun& result);

/// A gap or a hysteresis of negative size is the reference's, or of a compensation of the device's that is set too high. In motion
/// beside a latency or a scale, or wider than errors at equal angles are apart, it is what those leave for the most part: not
/// sure (60 %). At stops there is no latency, and a scale has no direction.
void DoubtLeadingLoops(const EncoderRun& encoder, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
