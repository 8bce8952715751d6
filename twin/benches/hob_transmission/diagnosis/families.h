#pragma once

#include <string>
#include <vector>

#include "twin/benches/hob_transmission/diagnosis/hob_run.h"
#include "twin/diagnose/engine/family.h"

/// Candidates for a hobbing machine's transmission chain: every effect of the catalogue that leaves a trace in this
/// run, and generic shapes for what the catalogue has not.
namespace twinbench::diagnose::hob {

/// Named families, then unknown ones; they own what they need.
///
/// The encoders' causes show in m alone, what the table does shows to the interferometer as well. Where there is
/// none, causes of one order have the same columns and the same prior size, and tie: hob_runout and eccentricity of
/// the hob's encoder, gear_mesh and its ellipticity, backlash and latency at one speed. The errors of the table's
/// ring are locked to the ring's own angle; those of order k are seen as far as the heads tell them from the free
/// error of the transmission.
///
/// Prior sizes: a trace of 1 arcsec rms in m, or three times the noise of a row if that is more.
///
/// @param excluded  Effects taken out of the catalogue. The unknown ones are the same whatever is excluded.
std::vector<Family> Families(const HobRun& hob, const std::vector<std::string>& excluded = {});

}  // namespace twinbench::diagnose::hob
