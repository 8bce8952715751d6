#pragma once

#include <functional>
#include <vector>

#include "twin/core/reading.h"
#include "twin/plausible/finding.h"

namespace twinbench::plausible {

/// How a scenario's procedure goes on from a reading to the next one of its pass [s].
struct Interval {
  double least_s = 0.0;  // none can be five times as fast; 0: not known
  double usual_s = 0.0;  // none takes 300 times as long; 0: not known
};

/// What a scenario's own procedure says of a run's readings.
struct Plan {
  int readings = 0;  // of the whole run; 0: nothing is planned
  int positions =
      0;  // of the longest pass of the full circle: others make it another plan, of which nothing is known
  std::function<Interval(const Reading& before, const Reading& here)> interval = {};
};

/// Readings that are left out without a word, or that the plan does not have; a clock in another unit.
void CheckPlan(const std::vector<Reading>& readings, const Plan& plan, std::vector<Finding>& findings);

}  // namespace twinbench::plausible
