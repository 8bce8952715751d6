#pragma once

#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"
#include "twin/benches/turntable_autocollimator/twin/factory.h"

namespace twinbench::diagnose::turntable {

/// Readings as a diagnosis takes them, against the twin that follows them.
inline TurntableRun RunOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return BuildRun(readings, scenario, benches::turntable::FollowRecord);
}

}  // namespace twinbench::diagnose::turntable
