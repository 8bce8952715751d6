#pragma once

#include <vector>

#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

/// Every named cause by itself, most probable first: the sizes at which it explains most of the run at a point of its
/// grid, its probability by its evidence alone against nothing and all others, and that evidence (all its variants
/// together). Uncertainties of amplitudes are those at that point; of shapes, the distance of the next one.
/// @param alone  The first scan.
std::vector<Cause> CausesAlone(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                               const Scanner& scanner, const Evidence& alone);

}  // namespace twinbench::diagnose
