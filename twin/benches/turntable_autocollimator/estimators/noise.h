#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/stops.h"

namespace twinbench::separate::turntable {

/// Standard uncertainty of one reading of the autocollimator, seating of the multi-tooth table included if it was
/// seated anew for every reading.
struct AutocollimatorNoise {
  double u_x_rad = kNaN;
  double u_y_rad = kNaN;
  int dof = 0;  // of an estimate; 0: stated
};

/// Pools the scatter of readings of the same set-up, position and direction. A drift from pass to pass counts as
/// noise; what is the same in all passes is not seen. NaN and 0 degrees of freedom if nothing was read twice.
AutocollimatorNoise NoiseOfRepeats(const std::vector<TurntableStop>& stops, const StopGrid& grid);

}  // namespace twinbench::separate::turntable
