#pragma once

#include "hw_bridge/open_machine.h"
#include "tests/support/served_twin.h"
#include "tests/support/troubled_bench.h"
#include "twin/benches/registry.h"
#include "twin/procedure/machine_options.h"

/// Runs of the real procedures of benches with a machine: on the twin, and on a served twin through the network.
namespace twinbench::test {

struct MachineTwin {
  std::unique_ptr<MachineDevices> devices;
  std::vector<ReadingColumn> columns;
};

class ServedMachineTwin : MachineTwin, public RunningServer {
 public:
  explicit ServedMachineTwin(const Scenario& scenario, double speed = std::numeric_limits<double>::infinity())
      : MachineTwin{BenchOf(scenario).make_devices(scenario), InstrumentColumns(BenchOf(scenario).format->columns)},
        RunningServer(devices->Devices(), columns, scenario, OnFreePorts(speed)) {}

  /// The bench file that drives it, as `serve --write-bench` writes it.
  std::string BenchFile(const std::string& machine = "esp") const {
    std::vector<std::string> fields = {"time_ns", "status"};
    for (const ReadingColumn& column : columns) fields.push_back(column.name);
    return hw::WriteServedMachineFile(at(), machine, fields, devices->Devices().indexer != nullptr);
  }
};

struct MachineRun {
  MemoryLog log;
  std::string stopped_by, said;  // the fault that ended it; empty: it was carried out
};

inline std::string TextOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return TextOf(readings, scenario.bench);
}

/// The scenario's procedure on its twin inside this program.
inline std::vector<Reading> DrivenInProcess(const Scenario& scenario) {
  const auto twin = BenchOf(scenario).make_devices(scenario);
  MachineBench bench = twin->Devices();
  MemoryLog log;
  BenchOf(scenario).drive(bench, scenario, log, {}, {});
  return log.readings;
}

/// @param faults       Injected when so many readings are kept.
/// @param before_call  Called before every call of a device; may be empty.
inline MachineRun RunServedMachine(const ServedMachineTwin& served, const Scenario& scenario,
                                   const std::string& bench_file, std::map<int, std::string> faults = {},
                                   const std::vector<Reading>& kept = {},
                                   const TroubledMachine::Trouble& before_call = {}) {
  MachineRun run;
  run.log.readings = kept;
  try {
    const Bench& whole = BenchOf(scenario);
    const std::vector<MachineAxis> axes = whole.make_devices(scenario)->Devices().machine.Axes();
    const auto opened = hw::OpenMachineHardware(hw::ParseMachineFile(bench_file, "served.toml", axes), axes,
                                                InstrumentColumns(whole.format->columns));
    TroubledMachine watched(opened->Devices(), InstrumentColumns(whole.format->columns), before_call);
    MachineBench bench = watched.Bench();
    if (kept.empty()) bench.simulation->Restart();
    procedure::MachineOptions options;
    options.axes = opened->Limits();
    options.log = &run.log;
    options.kept = kept;
    InjectingSink sink(served, std::move(faults), run.log);
    whole.drive(bench, scenario, sink, {}, options);
  } catch (const DeviceFault& fault) {
    run.stopped_by = FaultName(fault.kind());
    run.said = fault.what();
  }
  return run;
}

}  // namespace twinbench::test
