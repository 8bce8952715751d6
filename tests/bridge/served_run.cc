#include "tests/bridge/served_run.h"

#include <fstream>
#include <sstream>

#include "hw_bridge/control/line_link.h"
#include "hw_bridge/open_bench.h"
#include "tests/core/input_error.h"
#include "twin/core/device_fault.h"

namespace twinbench::test {
namespace {

std::string TextOf(const std::vector<Reading>& readings) {
  std::ostringstream text;
  WriteReadingsCsv(readings, text);
  return text.str();
}

hw::BenchFile BenchFileOf(const ServedTwin& served, const RunOptions& options) {
  const TemporaryFolder folder;
  folder.Write("bench.toml", hw::WriteServedBenchFile(served.at(), options.tables));
  hw::BenchFile file = hw::LoadBenchFile(folder.File("bench.toml"));
  file.adc.timeout_s = 0.5;
  for (hw::ControlSettings* device : {&file.target, &file.reference, &file.autocollimator, &file.thermometer,
                                      &file.goniometer, &file.fixture, &file.clock})
    device->timeout_s = 0.5;
  if (options.alter) options.alter(file);
  return file;
}

/// Asks for faults at their readings, once each.
class Injecting : public ReadingSink {
 public:
  Injecting(const ServedTwin& served, std::map<int, std::string> faults, MemoryLog& log)
      : served_(served), faults_(std::move(faults)), log_(log) {
    InjectAt(0);
  }
  void Append(const Reading& reading, const Acquisition& block) override {
    log_.Append(reading, block);
    InjectAt(static_cast<int>(log_.readings.size()));
  }

 private:
  void InjectAt(int kept) {
    const auto fault = faults_.find(kept);
    if (fault == faults_.end()) return;
    Inject(served_, fault->second);
    faults_.erase(fault);
  }

  const ServedTwin& served_;
  std::map<int, std::string> faults_;
  MemoryLog& log_;
};

procedure::Options CarefulOptions(const hw::BenchFile& file, ServedRun& run, const ServedRun* before) {
  procedure::Options options;
  options.target = file.target_limits;
  options.reference = file.reference_limits;
  options.attempts = file.attempts;
  options.log = &run.log;
  if (!before) return options;
  run.log = before->log;
  options.readings_done = static_cast<int>(before->log.readings.size());
  options.calls_done = before->log.calls;
  return options;
}

}  // namespace

Scenario RestlessBench() {
  Scenario scenario;
  scenario.seed = 23;
  scenario.procedure.positions = 6;
  scenario.procedure.shifts = {0, 1};
  scenario.procedure.passes = {1, -1};
  scenario.procedure.sweep_points = 3;
  scenario.procedure.dwell_s = {1.0, 2.0, 7.0};
  scenario.procedure.remount_s = 60.0;
  scenario.environment.drift_K_h = 2.0;
  scenario.environment.random_walk_K_sqrt_h = 0.1;
  scenario.laser.pointing_yaw_per_kelvin_rad = 1e-5;
  scenario.reference.seating_sd[2] = 20.0 * units::arcsec;
  scenario.reference.seating_sd[0] = 20.0 * units::arcsec;
  scenario.target.repeatability_sd[0] = 1.0 * units::arcsec;
  scenario.target.random_rms = {4e-5, 4e-5, 4e-5, 2e-6, 2e-6, 1e-6};
  return scenario;
}

void Inject(const ServedTwin& served, const std::string& fault) {
  const auto address = hw::ParseAddress(served.ScpiAddress());
  const auto patience = std::chrono::seconds(5);
  hw::OpenedLink opened = hw::OpenLink(address.value(), patience);
  if (!opened.link) throw BenchError("no connection to inject a fault: " + opened.why);
  opened.link->Send("SIM:FAUL " + fault + ";SYST:ERR?\n", patience);
  const std::string answer = opened.link->ReadLine(patience).line;
  if (!answer.starts_with("0,")) throw BenchError("fault " + fault + ": " + answer);
}

std::string ServedRun::Readings() const {
  return TextOf(log.readings);
}

ServedRun RunServed(const ServedTwin& served, const Scenario& scenario, const RunOptions& options,
                    const ServedRun* before) {
  ServedRun run;
  try {
    const hw::BenchFile file = BenchFileOf(served, options);
    const auto opened = hw::OpenBench(file, scenario);
    RotaryBench bench = opened->Bench();
    bench.simulation->Restart();
    const procedure::Options careful = CarefulOptions(file, run, before);
    Injecting sink(served, options.faults, run.log);
    procedure::CarryOut(bench, scenario, sink, {}, careful);
  } catch (const DeviceFault& fault) {
    run.stopped_by = FaultName(fault.kind());
    run.said = fault.what();
  }
  return run;
}

std::string InProcess(const Scenario& scenario) {
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  MemoryLog log;
  procedure::CarryOut(bench, scenario, log);
  return TextOf(log.readings);
}

}  // namespace twinbench::test
