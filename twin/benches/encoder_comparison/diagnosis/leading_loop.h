#pragma once

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/diagnose/extend.h"

namespace twinbench::diagnose::encoder {

/// A gap or a hysteresis of negative size is the reference's, or of a compensation of the device's that is set too high. In motion
/// beside a latency or a scale, or wider than errors at equal angles are apart, it is what those leave for the most part: not
/// sure (60 %). At stops there is no latency, and a scale has no direction.
void DoubtLeadingLoops(const EncoderRun& encoder, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
