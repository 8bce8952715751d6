#include "twin/benches/hob_transmission/twin/factory.h"

#include "twin/benches/hob_transmission/procedure.h"
#include "twin/benches/hob_transmission/twin/twin.h"
#include "twin/sim/simulated_machine.h"

namespace twinbench::benches::hob {

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<sim::SimulatedMachine<sim::HobTwin, procedure::DriveHob>>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  return std::make_unique<sim::HobTwin>(scenario);
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowHob(scenario, record);
}

}  // namespace twinbench::benches::hob
