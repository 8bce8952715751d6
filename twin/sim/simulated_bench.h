#pragma once

#include <nlohmann/json.hpp>

#include "twin/core/bench.h"
#include "twin/core/run_record.h"
#include "twin/core/scenario.h"

namespace twinbench::sim {

/// The procedure of the devices that a bench has, found by their type.
template <class Devices>
void CarryOutOn(Devices& devices, const Scenario& scenario, RunRecord& record,
                const std::function<void(const procedure::Progress&)>& progress) {
  CarryOut(devices, scenario, record, progress);
}

/// A twin whose devices a procedure is carried out on without further options.
/// @tparam SimTwin  Has Bench() and Truth(); procedure::CarryOut takes what Bench() gives.
template <class SimTwin>
class SimulatedBench : public BenchTwin {
 public:
  explicit SimulatedBench(const Scenario& scenario) : scenario_(scenario), twin_(scenario) {}

  nlohmann::json Truth() const override { return twin_.Truth(); }
  void CarryOut(RunRecord& record, const std::function<void(const procedure::Progress&)>& progress) override {
    auto bench = twin_.Bench();
    CarryOutOn(bench, scenario_, record, progress);
  }

 private:
  Scenario scenario_;
  SimTwin twin_;
};

}  // namespace twinbench::sim
