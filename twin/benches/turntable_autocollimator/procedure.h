#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/devices.h"
#include "twin/core/scenario.h"
#include "twin/procedure/options.h"

/// How the bench turntable_autocollimator is measured: at every stop the turntable has turned by a whole number of
/// teeth, the multi-tooth table has turned the mirror back by as many, and the autocollimator reads what is left. A
/// polygon has a face for every stop instead; the turntable is turned until the autocollimator shows zero of it,
/// and its encoder is read.
namespace twinbench {

/// The turntable's drive in one loop with the autocollimator: the instrument's error signal turns the table.
class NullServo {
 public:
  virtual ~NullServo() = default;
  /// Turns the table until x is within the deadband, and comes to that place from behind in `direction`. Returns
  /// when the table stands; the encoder says where.
  /// @return false if there is nothing to see or x did not come to rest within the deadband.
  virtual bool Null(int direction) = 0;
};

/// The devices of the bench and the servo between two of them. Does not own them.
struct NullingTurntableBench : TurntableBench {
  NullServo& servo;
};

}  // namespace twinbench

namespace twinbench::procedure {

/// Carries out the phases of `scenario.turntable_procedure` in their order; every reading goes to `sink` as soon as
/// it is made.
///
/// full_circle: each set-up is mounted (tilt, azimuth, eccentricity, shift) and all passes go through the
/// positions. With a polygon a set-up is a clamping of it, and a reading's turntable angle is what the encoder
/// shows with the face nulled, its multi-tooth angle that of the face on the polygon; a face that could not be
/// nulled is read as it is. calibration: the turntable alone sweeps `sweep_rad` about position 0, always upwards.
/// verification: stops at whole teeth that are no position. These two stay in the set-up that is there; the first
/// is mounted if none is.
///
/// @throws BenchError from the devices; what was appended before stays in the sink.
/// Reference: Guo et al. (2014), sections 1, 3 and 5; Kinnane et al., Metrologia 52 (2015) 244 (polygon).
void CarryOut(NullingTurntableBench& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress = {});

int PlannedReadings(const TurntableProcedureSettings& procedure);

/// Check positions of the verification, in teeth: `count` of those that are no position of the grid, spread evenly.
std::vector<int> CheckTeeth(int teeth, int positions, int count);

}  // namespace twinbench::procedure
