#pragma once

#include "twin/core/bench.h"

namespace twinbench::benches::turntable {

/// @throws InputError if the scenario's parts cannot be built.
std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario);

}  // namespace twinbench::benches::turntable
