#pragma once

#include <memory>

#include "twin/core/scenario.h"
#include "twin/sim/driven_machine.h"

namespace twinbench::sim {

/// The circles' machine and its instruments, to be driven: on the plan of the scenario it shows what CircleRun
/// does, beside it what the same machine shows there.
std::unique_ptr<DrivenPhysics> MakeCirclePhysics(const Scenario& scenario);

}  // namespace twinbench::sim
