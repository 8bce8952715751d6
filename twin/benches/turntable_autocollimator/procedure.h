#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/devices.h"
#include "twin/core/scenario.h"
#include "twin/procedure/options.h"

/// How the bench turntable_autocollimator is measured: at every stop the turntable has turned by a whole number of
/// teeth, the multi-tooth table has turned the mirror back by as many, and the autocollimator reads what is left.
namespace twinbench::procedure {

/// Carries out the phases of `scenario.turntable_procedure` in their order; every reading goes to `sink` as soon as
/// it is made.
///
/// full_circle: each set-up is mounted (tilt, azimuth, eccentricity, shift) and all passes go through the
/// positions. calibration: the turntable alone sweeps `sweep_rad` about position 0, always upwards. verification:
/// stops at whole teeth that are no position. These two stay in the set-up that is there; the first is mounted if
/// none is.
///
/// @throws BenchError from the devices; what was appended before stays in the sink.
/// Reference: Guo et al. (2014), sections 1, 3 and 5.
void CarryOut(TurntableBench& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress = {});

int PlannedReadings(const TurntableProcedureSettings& procedure);

/// Check positions of the verification, in teeth: `count` of those that are no position of the grid, spread evenly.
std::vector<int> CheckTeeth(int teeth, int positions, int count);

}  // namespace twinbench::procedure
