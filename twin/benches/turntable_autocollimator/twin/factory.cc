#include "twin/benches/turntable_autocollimator/twin/factory.h"

#include "twin/benches/turntable_autocollimator/procedure.h"
#include "twin/benches/turntable_autocollimator/twin/mirror_path.h"
#include "twin/benches/turntable_autocollimator/twin/twin.h"
#include "twin/sim/simulated_machine.h"

namespace twinbench::benches::turntable {

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<sim::SimulatedMachine<sim::TurntableTwin, procedure::DriveTurntable>>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  return std::make_unique<sim::TurntableTwin>(scenario);
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowTurntable(scenario, record);
}

model::FollowMaker FollowOften() {
  return
      [images = std::make_shared<sim::ImagesOnce>()](const Scenario& scenario, const std::vector<Reading>& record) {
        return sim::FollowTurntable(scenario, record, images);
      };
}

}  // namespace twinbench::benches::turntable
