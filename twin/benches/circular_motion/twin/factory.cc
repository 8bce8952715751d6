#include "twin/benches/circular_motion/twin/factory.h"

#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/procedure/drive.h"
#include "twin/benches/circular_motion/twin/driven.h"
#include "twin/benches/circular_motion/twin/follow.h"
#include "twin/benches/circular_motion/twin/live.h"

namespace twinbench::benches::circular {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario) {}
  nlohmann::json Truth() const override { return sim::CircleRun(scenario_).Truth(); }

  void CarryOut(ReadingSink& readings, const procedure::ProgressCallback& progress, RunLog* /*log*/) override {
    const auto devices = MakeDevices(scenario_);
    MachineBench bench = devices->Devices();
    procedure::DriveCircles(bench, scenario_, readings, progress, {});
  }

 private:
  Scenario scenario_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
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
