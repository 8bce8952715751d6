#pragma once

#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/noise_model.h"

namespace twinbench::diagnose::encoder {

/// Orders 1 to 12 (or as many as the spacing of the readings resolves) in one fit beside the device's offsets.
/// Uncertainty: the noise model's, scaled by what the fit leaves over. Not included: what is not harmonic.
/// Empty where the readings do not tell orders apart, as where they cover less than a turn.
std::vector<Harmonic> HarmonicTable(const EncoderRun& encoder, const NoiseModel& noise);

}  // namespace twinbench::diagnose::encoder
