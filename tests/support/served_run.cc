#include "tests/support/served_run.h"

#include "hw_bridge/ad/ad_source.h"

namespace twinbench::test {
namespace {

/// The card that the preloaded library shows, with this twin's counts.
void UseComedi(const ServedTwin& served, hw::AdSettings& adc) {
  setenv("TWINBENCH_COMEDI_TWIN", (served.at().host + ":" + std::to_string(served.at().iiod_port)).c_str(), 1);
  adc.kind = "comedi";
  adc.device = "/dev/comedi0";
  adc.channels = {"0", "1", "2", "3"};
  adc.light = "1";
}

procedure::Options CarefulOptions(const hw::BenchFile& file, ServedRun& run, const ServedRun* before) {
  procedure::Options options;
  options.target = file.target_limits;
  options.reference = file.reference_limits;
  options.attempts = file.attempts;
  options.log = &run.log;
  if (!before) return options;
  run.log = before->log;
  options.kept = before->log.readings;
  options.calls_done = before->log.calls;
  return options;
}

}  // namespace

std::string MissingComedi() {
  if (!hw::HasAdDriver("comedi")) return "this build has no comedi";
  const char* preloaded = std::getenv("LD_PRELOAD");
  return preloaded ? "" : "needs the preloaded card; ctest brings it";
}

hw::BenchFile BenchFileOf(const ServedTwin& served, const RunOptions& options) {
  hw::BenchFile file =
      hw::ParseBenchFile(hw::WriteServedBenchFile(served.at(), options.tables), "served.toml", "/");
  if (options.converter == "comedi") UseComedi(served, file.adc);
  file.adc.timeout_s = kForAnAnswer_s;
  for (hw::ControlSettings* device : {&file.target, &file.reference, &file.autocollimator, &file.thermometer,
                                      &file.goniometer, &file.fixture, &file.clock})
    device->timeout_s = kForAnAnswer_s;
  if (options.alter) options.alter(file);
  return file;
}

std::string ServedRun::Readings() const { return TextOf(log.readings); }

ServedRun RunServed(const ServedTwin& served, const Scenario& scenario, const RunOptions& options,
                    const ServedRun* before) {
  ServedRun run;
  try {
    const hw::BenchFile file = BenchFileOf(served, options);
    const auto opened = test::OpenHardware(file, scenario);
    RotaryBench bench = opened->Bench();
    bench.simulation->Restart();
    const procedure::Options careful = CarefulOptions(file, run, before);
    InjectingSink sink(served, options.faults, run.log);
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
