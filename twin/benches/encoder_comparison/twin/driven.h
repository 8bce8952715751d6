#pragma once

#include <memory>

#include "twin/core/scenario.h"
#include "twin/sim/driven_machine.h"

namespace twinbench::sim {

/// The shaft of a comparison at stops and what both devices show, for a machine that is driven.
std::unique_ptr<DrivenPhysics> MakeShaftPhysics(const Scenario& scenario);

}  // namespace twinbench::sim
