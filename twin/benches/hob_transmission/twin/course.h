#pragma once

#include <string>
#include <vector>

#include "twin/benches/hob_transmission/twin/path.h"
#include "twin/core/reading.h"

namespace twinbench::sim {

/// One sample of a record: how the machine ran, and what effects add to what is shown.
struct HobStop {
  double hob_shown_rad = kNaN;  // as recorded, but for what effects add
  double zero_rad = 0.0;        // of the table, where the hob's encoder shows zero
  double hob_speed_rad_s = 0.0;
  int direction = 1;    // in which the wheel drags the table
  CounterSample added;  // by effects
};

struct HobCourse {
  std::vector<HobStop> stops;        // one a reading
  std::vector<std::string> unfixed;  // what the record does not say and what was taken instead
};

/// The course of a record. The hob's angle is what each sample is known by: with it the table's follows.
///
/// @param path  Its effects are led along the course, out to where the table turned round behind each pass.
HobCourse FollowCourse(const std::vector<Reading>& record, HobPath& path);

}  // namespace twinbench::sim
