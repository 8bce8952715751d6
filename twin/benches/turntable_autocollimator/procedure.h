#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// What the bench turntable_autocollimator is to read: at every stop the turntable has turned by a whole number of
/// teeth, the multi-tooth table has turned the mirror back by as many, and the autocollimator reads what is left. A
/// polygon has a face for every stop instead; the turntable is turned until the autocollimator shows zero of it,
/// and its encoder is read. procedure/drive.h is how.
namespace twinbench::procedure {

/// The readings of the phases of `scenario.turntable_procedure` in their order, with the angles of both tables and the
/// dwell that is drawn for each. Their times are not known before they are taken.
///
/// full_circle: all passes go through the positions in each set-up (tilt, azimuth, eccentricity, shift). With a polygon
/// a set-up is a clamping of it, a reading's turntable angle the nominal one at which the face is seen, its multi-tooth
/// angle that of the face on the polygon. calibration: the turntable alone sweeps `sweep_rad` about position 0, always
/// upwards. verification: stops at whole teeth that are no position. These two stay in the set-up that is there.
/// Reference: Guo et al. (2014), sections 1, 3 and 5; Kinnane et al., Metrologia 52 (2015) 244 (polygon).
std::vector<Reading> TurntableSchedule(const Scenario& scenario);

int PlannedReadings(const TurntableProcedureSettings& procedure);

/// Check positions of the verification, in teeth: `count` of those that are no position of the grid, spread evenly.
std::vector<int> CheckTeeth(int teeth, int positions, int count);

}  // namespace twinbench::procedure
