#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// The circumstances of the readings, as recorded. What a bench does not have (a target's angle, a velocity) is
/// NaN.
Schedule ScheduleOf(const std::vector<Reading>& used);

}  // namespace twinbench::diagnose
