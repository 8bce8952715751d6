#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

/// What the bench turntable_autocollimator is to read: at every stop the turntable has turned by a whole number of
/// teeth, the multi-tooth table has turned the mirror back by as many, and the autocollimator reads what is left. A
/// polygon has a face for every stop instead; the turntable is turned until the autocollimator shows zero of it,
/// and its encoder is read.
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

/// Carries a scenario's stops out on any such bench: one rotary axis (the turntable), an autocollimator's x and y among
/// the instruments, and an indexer unless a polygon stands on the turntable.
///
/// Every pass comes from behind its first stop. The multi-tooth table is seated anew at every stop, while the turntable
/// moves unless somebody turns it by hand. With a polygon the turntable is turned until the autocollimator shows zero of
/// the face, or as little as it comes to, and the reading's turntable angle is what its encoder shows then; a face that is
/// not seen is read as it is.
/// @throws what CarryOutPlan throws; DeviceFault kRefused for a bench with other axes or without an indexer.
void DriveTurntable(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                    const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
