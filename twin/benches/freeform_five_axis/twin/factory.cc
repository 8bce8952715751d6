#include "twin/benches/freeform_five_axis/twin/factory.h"

#include <nlohmann/json.hpp>

#include "twin/benches/freeform_five_axis/procedure/drive.h"
#include "twin/benches/freeform_five_axis/twin/driven.h"
#include "twin/benches/freeform_five_axis/twin/follow.h"
#include "twin/benches/freeform_five_axis/twin/twin.h"

namespace twinbench::benches::freeform {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario) {}
  nlohmann::json Truth() const override { return sim::FreeformTruth(scenario_, sim::Draw(scenario_)); }

  void CarryOut(ReadingSink& readings, const procedure::ProgressCallback& progress, RunLog* /*log*/) override {
    const auto devices = MakeDevices(scenario_);
    MachineBench bench = devices->Devices();
    procedure::DriveFreeform(bench, scenario_, readings, progress, {});
  }

 private:
  Scenario scenario_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  return std::make_unique<sim::DrivenMachine>(sim::MakeFreeformPhysics(scenario));
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowFreeform(scenario, record);
}

}  // namespace twinbench::benches::freeform
