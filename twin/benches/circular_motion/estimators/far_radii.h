#pragma once

#include <vector>

#include "twin/core/reading.h"

/// Single readings of a circle that its largest and smallest radius would be made of.
namespace twinbench::separate::circular {

struct FarRadius {
  int reading = 0;  // its number
  double target_rad = 0.0;
  double off_m = 0.0;  // from the curve through its neighbours
  double times = 0.0;  // the scatter of the others of its pass
};

/// Takes out single readings whose radius lies far from the curve through its neighbours, which agree without it, in one turn and
/// in no other that way round. Of a place that is gone through once none just behind a reversal: there an axis may do so.
/// @param readings  With angles.
/// @return what was taken out, the farthest of each pass first; none of a pass where they are so many that the machine moves so.
std::vector<FarRadius> TakeOutFar(std::vector<Reading>& readings);

}  // namespace twinbench::separate::circular
