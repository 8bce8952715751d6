#pragma once

#include <vector>

#include "twin/benches/hob_transmission/diagnosis/hob_run.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/noise_model.h"

namespace twinbench::diagnose::hob {

/// Orders 1 to 12 by turns of the table, and those of hob, mesh and worm where they are whole: amplitude and phase
/// of m in one fit beside the constants of the set-ups, what is stated taken off. With several heads the ring's
/// share is averaged over them. Uncertainty: the noise model's, scaled by what the fit leaves over. Not included:
/// what is not harmonic.
std::vector<Harmonic> HarmonicTable(const HobRun& hob, const NoiseModel& noise);

}  // namespace twinbench::diagnose::hob
