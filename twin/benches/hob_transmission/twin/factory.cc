#include "twin/benches/hob_transmission/twin/factory.h"

#include <nlohmann/json.hpp>

#include "twin/benches/hob_transmission/procedure/drive.h"
#include "twin/benches/hob_transmission/twin/follow.h"
#include "twin/benches/hob_transmission/twin/twin.h"
#include "twin/core/run_record.h"

namespace twinbench::benches::hob {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario), twin_(scenario) {}
  nlohmann::json Truth() const override { return twin_.Truth(); }
  void CarryOut(RunRecord& record, const procedure::ProgressCallback& progress) override {
    MachineBench bench = twin_.Devices();
    procedure::DriveHob(bench, scenario_, record, progress, {});
  }

 private:
  Scenario scenario_;
  sim::HobTwin twin_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
}

std::unique_ptr<MachineDevices> MakeDevices(const Scenario& scenario) {
  return std::make_unique<sim::HobTwin>(scenario);
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowHob(scenario, record);
}

}  // namespace twinbench::benches::hob
