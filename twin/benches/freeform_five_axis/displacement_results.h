#pragma once

#include <vector>

#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

namespace twinbench::benches::freeform {

/// Results of readings of displacements at poses: errors of the machine by their ISO names, each with u where the
/// readings show it, the others by name.
report::Evaluation EvaluateDisplacements(const Scenario& scenario, const std::vector<Reading>& readings);

/// @throws InputError where readings are displacements: nothing simulates their machine.
/// @param what  That is asked for: "a simulation".
void RefuseDisplacements(const Scenario& scenario, const std::string& what);

}  // namespace twinbench::benches::freeform
