#pragma once

#include "twin/core/bench.h"
#include "twin/core/machine.h"
#include "twin/model/follow.h"

namespace twinbench::benches::circular {

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario);

/// The twin as the devices of a bench.
std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario);

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record);

/// The same for one who asks often: axes that are bodies are run once for the same drives on the same record.
model::FollowMaker FollowOften();

}  // namespace twinbench::benches::circular
