#pragma once

#include <algorithm>
#include <cmath>
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

/// Of an axis that is read at rest, on a real bench too.
inline Interval AtRest(double dwell_s) {
  constexpr double kMoveAndRead_s = 2.0;
  return {dwell_s, dwell_s + kMoveAndRead_s};
}

/// Of what is driven at a speed.
inline Interval InMotion(double way, double speed) {
  return {std::abs(way / speed), std::abs(way / speed)};
}

/// Of stops that wait for one of some dwells: a reading says itself for which, if anything does.
inline Interval BesideDwell(const std::vector<double>& dwells_s, const Reading& here) {
  return AtRest(std::isfinite(here.dwell_s) ? here.dwell_s : std::ranges::min(dwells_s));
}

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
