#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

namespace twinbench::diagnose::encoder {

/// A reference that is read in motion has noise, and speeds that are taken from it have more. Readings of a sweep are moved
/// to where the shaft was by its steady course (model::SteadyCourseOf), the reference and the device alike, and have the
/// speeds of that: the error of a reading stays what it is, and what goes by angle, speed or time sees no noise of the
/// reading that it is compared with. Readings whose reference is steady are left as they are.
std::vector<Reading> OnSteadyCourse(std::vector<Reading> readings, const Scenario& scenario);

}  // namespace twinbench::diagnose::encoder
