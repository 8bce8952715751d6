#include "twin/benches/turntable_autocollimator/twin/factory.h"

#include <nlohmann/json.hpp>

#include "twin/benches/turntable_autocollimator/procedure/drive.h"
#include "twin/benches/turntable_autocollimator/twin/follow.h"
#include "twin/benches/turntable_autocollimator/twin/twin.h"
#include "twin/core/run_record.h"

namespace twinbench::benches::turntable {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario), twin_(scenario) {}
  nlohmann::json Truth() const override { return twin_.Truth(); }
  void CarryOut(RunRecord& record, const procedure::ProgressCallback& progress) override {
    MachineBench bench = twin_.Devices();
    procedure::DriveTurntable(bench, scenario_, record, progress, {});
  }

 private:
  Scenario scenario_;
  sim::TurntableTwin twin_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  return std::make_unique<sim::TurntableTwin>(scenario);
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowTurntable(scenario, record);
}

}  // namespace twinbench::benches::turntable
