#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "hw_bridge/control/line_link.h"
#include "hw_bridge/open_machine.h"
#include "hw_bridge/serve/server.h"
#include "tests/support/memory_log.h"
#include "tests/support/troubled_bench.h"
#include "twin/benches/registry.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/machine_options.h"

/// Runs of the real procedures of benches with a machine: on the twin, and on a served twin through the network.
namespace twinbench::test {

/// A machine's twin that is served from a thread, until this goes.
class ServedMachineTwin {
 public:
  explicit ServedMachineTwin(const Scenario& scenario, double speed = std::numeric_limits<double>::infinity())
      : devices_(BenchOf(scenario).make_devices(scenario)),
        columns_(InstrumentColumns(BenchOf(scenario).format->columns)),
        server_(devices_->Devices(), columns_, scenario, OnAnyPort(speed)),
        thread_([this] { server_.Run(); }) {}
  ~ServedMachineTwin() {
    server_.Stop();
    thread_.join();
  }

  hw::ServedAddresses at() const { return server_.Addresses(); }
  /// The bench file that drives it, as `serve --write-bench` writes it.
  std::string BenchFile(const std::string& machine = "esp") const {
    std::vector<std::string> fields = {"time_ns", "status"};
    for (const ReadingColumn& column : columns_) fields.push_back(column.name);
    return hw::WriteServedMachineFile(at(), machine, fields, devices_->Devices().indexer != nullptr);
  }
  /// One answer of its SCPI port.
  std::string Ask(const std::string& line) const {
    const auto address = hw::ParseAddress("tcp:" + at().host + ":" + std::to_string(at().scpi_port));
    hw::OpenedLink opened = hw::OpenLink(address.value(), std::chrono::seconds(5));
    if (!opened.link) throw BenchError("no connection: " + opened.why);
    opened.link->Send(line + "\n", std::chrono::seconds(5));
    return opened.link->ReadLine(std::chrono::seconds(5)).line;
  }
  /// Asks it to suffer: "machine,limit".
  void Inject(const std::string& fault) const {
    const std::string answer = Ask("SIM:FAUL " + fault + ";SYST:ERR?");
    if (!answer.starts_with("0,")) throw BenchError("fault " + fault + ": " + answer);
  }

 private:
  static hw::ServeOptions OnAnyPort(double speed) {
    hw::ServeOptions options;
    options.iiod_port = options.scpi_port = options.esp_port = 0;
    options.speed = speed;
    return options;
  }

  std::unique_ptr<MachineDevices> devices_;
  std::vector<ReadingColumn> columns_;
  hw::Server server_;
  std::thread thread_;
};

struct MachineRun {
  MemoryLog log;
  std::string stopped_by, said;  // the fault that ended it; empty: it was carried out
};

inline std::string TextOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  std::ostringstream text;
  WriteReadingsCsv(readings, scenario.bench, text);
  return text.str();
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
  class Sink : public ReadingSink {
   public:
    Sink(MachineRun& run, std::function<void(int)> on_kept) : run_(run), on_kept_(std::move(on_kept)) {
      on_kept_(0);
    }
    void Append(const Reading& reading, const Acquisition& block) override {
      run_.log.Append(reading, block);
      on_kept_(static_cast<int>(run_.log.readings.size()));
    }

   private:
    MachineRun& run_;
    std::function<void(int)> on_kept_;
  };
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
    Sink sink(run, [&](int now) {
      while (!faults.empty() && faults.begin()->first <= now) {
        served.Inject(faults.begin()->second);
        faults.erase(faults.begin());
      }
    });
    whole.drive(bench, scenario, sink, {}, options);
  } catch (const DeviceFault& fault) {
    run.stopped_by = FaultName(fault.kind());
    run.said = fault.what();
  }
  return run;
}

}  // namespace twinbench::test
