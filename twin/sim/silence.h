#pragma once

#include "twin/core/scenario.h"

namespace twinbench::sim {

/// Takes out everything that is drawn at random from reading to reading; random table errors stay, they are errors.
void Silence(Scenario& scenario);

}  // namespace twinbench::sim
