#pragma once

#include "twin/benches/hob_transmission/diagnosis/hob_run.h"
#include "twin/benches/hob_transmission/twin/factory.h"

namespace twinbench::diagnose::hob {

/// Readings as a diagnosis takes them, against the twin that follows them.
inline HobRun RunOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return BuildRun(readings, scenario, benches::hob::FollowRecord);
}

}  // namespace twinbench::diagnose::hob
