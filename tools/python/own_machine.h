#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "twin/core/machine.h"
#include "twin/core/scenario.h"

/// Benches with a machine whose devices are methods of a Python object (twinbench/machines.py says which).
namespace twinbench::python {

/// What a bench of a scenario must have, as its twin has it.
struct MachineParts {
  std::vector<MachineAxis> axes;
  std::vector<AxisLimits> travel;       // one entry an axis, SI
  std::vector<double> start;            // where the axes stand at Time 0, SI
  std::vector<std::string> columns;     // of readings.csv, which the instruments show
  bool has_indexer = false;
};

/// @throws InputError if the scenario's bench has no machine that is driven.
MachineParts PartsOf(const Scenario& scenario);

/// The devices of a bench with a machine. It is no simulation: it cannot begin again.
class OwnMachineBench : public MachineDevices {
 public:
  /// @throws InputError if the object lacks a method, or the scenario is of a bench without a machine.
  OwnMachineBench(pybind11::object bench, const Scenario& scenario);
  ~OwnMachineBench() override;
  MachineBench Devices() override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace twinbench::python
