#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/stops.h"

namespace twinbench::separate::turntable {

/// A stop whose x is unlike all others of its place.
struct DisturbedStop {
  std::size_t stop = 0;  // index into the stops
  double times = kNaN;   // the scatter of a reading about the others of its place
};

/// Single stops that were disturbed: of places of one set-up that were met three times at least, whose others agree. What a
/// pass shows more than the others all along is taken out first. None where there are more than a few in a hundred: then
/// that is how the bench scatters, or a step.
///
/// @param noise_rad  Nothing is thought to scatter less, whatever few readings show.
std::vector<DisturbedStop> DisturbedStops(const std::vector<TurntableStop>& stops, const StopGrid& grid, double noise_rad);

}  // namespace twinbench::separate::turntable
