#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/separate/far_on_course.h"

/// Single readings of a circle that its largest and smallest radius would be made of.
namespace twinbench::separate::circular {

/// Takes them out. Of a place that is gone through once none just behind a reversal: there an axis may do so.
/// @param readings  With angles.
/// @return what was taken out: its radius.
std::vector<FarOnCourse> TakeOutFar(std::vector<Reading>& readings);

}  // namespace twinbench::separate::circular
