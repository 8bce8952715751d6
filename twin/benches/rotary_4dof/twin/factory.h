#pragma once

#include "twin/core/bench.h"
#include "twin/model/follow.h"

namespace twinbench::benches::rotary {

/// @throws InputError if the scenario's parts cannot be built.
std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario);

/// @throws InputError likewise.
std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record);

/// The same for one who asks often: drives are run once for the same moves.
model::FollowMaker FollowOften();

}  // namespace twinbench::benches::rotary
