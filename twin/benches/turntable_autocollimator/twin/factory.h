#pragma once

#include "twin/core/bench.h"
#include "twin/core/machine.h"
#include "twin/model/follow.h"

namespace twinbench::benches::turntable {

/// @throws InputError if the scenario's parts cannot be built.
std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario);

/// The same twin as devices that can be driven. @throws InputError likewise.
std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario);

/// @throws InputError likewise.
std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record);

/// The same for who follows one record again and again, as causes change: what they leave alone is seen once.
model::FollowMaker FollowOften();

}  // namespace twinbench::benches::turntable
