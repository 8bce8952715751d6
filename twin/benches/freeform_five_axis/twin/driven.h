#pragma once

#include <memory>

#include "twin/core/scenario.h"
#include "twin/sim/driven_machine.h"

namespace twinbench::sim {

/// The five-axis machine with its probe, to be driven. The probe looks at the cell that its plan says, or beside
/// the plan at the one under its beam.
std::unique_ptr<DrivenPhysics> MakeFreeformPhysics(const Scenario& scenario);

}  // namespace twinbench::sim
