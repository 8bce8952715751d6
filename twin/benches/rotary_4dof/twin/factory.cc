#include "twin/benches/rotary_4dof/twin/factory.h"

#include <nlohmann/json.hpp>

#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/scenario.h"

namespace twinbench::benches::rotary {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario), twin_(scenario) {}
  nlohmann::json Truth() const override { return ToJson(twin_.TheTruth()); }
  void CarryOut(ReadingSink& readings, const procedure::ProgressCallback& progress, RunLog* log) override {
    RotaryBench bench = twin_.Bench();
    procedure::Options options;
    options.log = log;
    procedure::CarryOut(bench, scenario_, readings, progress, options);
  }
  void WriteImages(const std::string& folder) override { twin_.WriteIrradiance(folder + "/irradiance.exr"); }

 private:
  Scenario scenario_;
  sim::Twin twin_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowRotary(scenario, record, std::make_shared<sim::DrivesOnce>());
}

model::FollowMaker FollowOften() {
  return
      [drives = std::make_shared<sim::DrivesOnce>()](const Scenario& scenario, const std::vector<Reading>& record) {
        return sim::FollowRotary(scenario, record, drives);
      };
}

}  // namespace twinbench::benches::rotary
