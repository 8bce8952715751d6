#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

namespace twinbench::benches::rotary {

/// As Bench::evaluate, of readings of displacement probes and tilt meters: error motions of the target in the terms
/// of ISO 230-7, and of its artefact what reversal or several probes separate.
report::Evaluation EvaluateProbes(const Scenario& scenario, const std::vector<Reading>& readings);

}  // namespace twinbench::benches::rotary
