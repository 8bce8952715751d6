#pragma once

#include "twin/core/bench.h"
#include "twin/core/machine.h"
#include "twin/model/follow.h"

namespace twinbench::benches::freeform {

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario);

/// The twin as the devices of a bench.
std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario);

/// Machine and mountings as the scenario says, without what it lets be drawn: a run leaves their errors free.
std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record);

}  // namespace twinbench::benches::freeform
