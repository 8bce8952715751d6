#include "twin/benches/freeform_five_axis/twin/factory.h"

#include "twin/benches/freeform_five_axis/procedure.h"
#include "twin/benches/freeform_five_axis/twin/twin.h"
#include "twin/sim/simulated_machine.h"

namespace twinbench::benches::freeform {
namespace {

nlohmann::json TruthOf(const Scenario& scenario) {
  return sim::FreeformTruth(scenario, sim::Draw(scenario));
}

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<sim::MachineOfScenario<TruthOf, MakeDevices, procedure::DriveFreeform>>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  return std::make_unique<sim::DrivenMachine>(sim::MakeFreeformPhysics(scenario));
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowFreeform(scenario, record);
}

}  // namespace twinbench::benches::freeform
