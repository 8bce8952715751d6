#include "twin/benches/encoder_comparison/twin/factory.h"

#include <nlohmann/json.hpp>

#include "twin/benches/encoder_comparison/procedure.h"
#include "twin/benches/encoder_comparison/twin/twin.h"
#include "twin/core/scenario.h"

namespace twinbench::benches::encoder {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario), twin_(scenario) {}
  nlohmann::json Truth() const override { return twin_.Truth(); }
  /// Stops are driven to as on a bench of devices; in motion the device is a function of its schedule's times, which
  /// driven sweeps come to as well.
  void CarryOut(ReadingSink& readings, const procedure::ProgressCallback& progress, RunLog* /*log*/) override {
    if (EncoderOf(scenario_).encoder_procedure.kind != "stops")
      return procedure::CarryOut(twin_, scenario_, readings, progress);
    const auto devices = MakeDevices(scenario_);
    MachineBench bench = devices->Devices();
    procedure::DriveComparison(bench, scenario_, readings, progress, {});
  }

 private:
  Scenario scenario_;
  sim::EncoderTwin twin_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  procedure::RequireDriven(scenario);
  return std::make_unique<sim::DrivenMachine>(sim::MakeShaftPhysics(scenario));
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowEncoder(scenario, record);
}

}  // namespace twinbench::benches::encoder
