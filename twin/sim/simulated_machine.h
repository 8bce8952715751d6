#pragma once

#include <nlohmann/json.hpp>

#include "twin/core/bench.h"
#include "twin/core/machine.h"
#include "twin/core/scenario.h"

namespace twinbench::sim {

/// A twin that is the devices of a MachineBench and knows its truth, driven by the bench's own procedure.
/// @tparam SimTwin  MachineDevices with Truth(), made of a scenario.
/// @tparam kDrive   As Bench::drive.
template <class SimTwin, auto kDrive>
class SimulatedMachine : public BenchTwin {
 public:
  explicit SimulatedMachine(const Scenario& scenario) : scenario_(scenario), twin_(scenario) {}

  nlohmann::json Truth() const override { return twin_.Truth(); }
  void CarryOut(ReadingSink& readings, const std::function<void(const procedure::Progress&)>& progress, RunLog* /*log*/) override {
    MachineBench bench = twin_.Devices();
    kDrive(bench, scenario_, readings, progress, {});
  }

 private:
  Scenario scenario_;
  SimTwin twin_;
};

/// The same of devices that are made for the run, with a truth that follows from the scenario.
template <auto kTruth, auto kDevices, auto kDrive>
class MachineOfScenario : public BenchTwin {
 public:
  explicit MachineOfScenario(const Scenario& scenario) : scenario_(scenario) {}

  nlohmann::json Truth() const override { return kTruth(scenario_); }
  void CarryOut(ReadingSink& readings, const std::function<void(const procedure::Progress&)>& progress, RunLog* /*log*/) override {
    const auto devices = kDevices(scenario_);
    MachineBench bench = devices->Devices();
    kDrive(bench, scenario_, readings, progress, {});
  }

 private:
  Scenario scenario_;
};

}  // namespace twinbench::sim
