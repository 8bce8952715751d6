#pragma once

#include "tests/support/memory_log.h"
#include "twin/benches/registry.h"
#include "twin/core/device_fault.h"
#include "twin/core/machine.h"
#include "twin/procedure/machine_options.h"

namespace twinbench::test {

/// The twin of a bench with a machine, and the procedure on it inside this program.
struct DrivenTwin {
  explicit DrivenTwin(const Scenario& its_scenario)
      : scenario(its_scenario), devices(BenchOf(scenario).make_devices(scenario)), bench(devices->Devices()) {
    options.log = &log;
  }
  DrivenTwin(const DrivenTwin&) = delete;
  DrivenTwin& operator=(const DrivenTwin&) = delete;

  void Drive() { DriveOn(bench); }
  void DriveOn(MachineBench& other) { BenchOf(scenario).drive(other, scenario, log, {}, options); }
  /// In which that ends; "": it was carried out.
  std::string Fault() { return FaultOn(bench); }
  std::string FaultOn(MachineBench& other) {
    try {
      DriveOn(other);
    } catch (const DeviceFault& fault) {
      said = fault.what();
      return FaultName(fault.kind());
    }
    return "";
  }

  const Scenario scenario;
  const std::unique_ptr<MachineDevices> devices;
  MachineBench bench;
  MemoryLog log;
  procedure::MachineOptions options;
  std::string said;  // by the latest fault
};

}  // namespace twinbench::test
