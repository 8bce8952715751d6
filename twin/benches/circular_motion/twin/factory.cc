#include "twin/benches/circular_motion/twin/factory.h"

#include "twin/benches/circular_motion/procedure.h"
#include "twin/benches/circular_motion/twin/live.h"
#include "twin/benches/circular_motion/twin/twin.h"
#include "twin/sim/simulated_machine.h"

namespace twinbench::benches::circular {
namespace {

nlohmann::json TruthOf(const Scenario& scenario) {
  return sim::CircleRun(scenario).Truth();
}

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<sim::MachineOfScenario<TruthOf, MakeDevices, procedure::DriveCircles>>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  return std::make_unique<sim::DrivenMachine>(sim::MakeCirclePhysics(scenario));
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowCircles(scenario, record, std::make_shared<sim::BodiesOnce>());
}

model::FollowMaker FollowOften() {
  return
      [bodies = std::make_shared<sim::BodiesOnce>()](const Scenario& scenario, const std::vector<Reading>& record) {
        return sim::FollowCircles(scenario, record, bodies);
      };
}

}  // namespace twinbench::benches::circular
