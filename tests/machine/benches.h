#pragma once

#include "tests/support/faults.h"
#include "tests/support/memory_log.h"
#include "twin/benches/registry.h"
#include "twin/procedure/machine_options.h"

/// Short runs of the benches with a machine, with effects that remember; what they are, tests/data/machine/ says.
namespace twinbench::test {

inline Scenario ShortScenario(const std::string& name) {
  return LoadScenario(TWINBENCH_TEST_DATA "/machine/" + name + ".toml");
}
inline Scenario ShortCircles() { return ShortScenario("short_circles"); }
inline Scenario ShortFreeform() { return ShortScenario("short_freeform"); }
inline Scenario ShortTurntable() { return ShortScenario("short_turntable"); }
inline Scenario ShortPolygon() { return ShortScenario("short_polygon"); }
inline Scenario ShortStops() { return ShortScenario("short_stops"); }
inline Scenario ShortSweep() { return ShortScenario("short_sweep"); }
inline Scenario ShortHob() { return ShortScenario("short_hob"); }

/// Of a circle all is kept or nothing; ShortCircles begins with two of 12 readings.
inline std::size_t KeptWhenStoppedAt(std::size_t readings, const Scenario& scenario) {
  return scenario.bench == "circular_motion" ? (readings + 11) / 12 * 12 : readings;
}

/// Somebody's bench with a machine, put through the contract of twin/core/machine.h.
struct AnyMachine {
  std::string name;  // letters and digits, of the test
  Scenario (*scenario)();
  std::function<std::unique_ptr<MachineDevices>(const Scenario&)> make;
  std::string missing = {};  // why it cannot be tried here

  friend void PrintTo(const AnyMachine& machine, std::ostream* out) { *out << machine.name; }
};

/// The benches of tests/python/own_machines.py, driven through the package that users have: those that can be sent somewhere.
std::vector<AnyMachine> PythonMachinesThatAreSent();
/// That turns on and on.
AnyMachine PythonMachineThatTurns();

/// The twin of a bench with a machine, and the procedure on it inside this program.
struct DrivenTwin {
  explicit DrivenTwin(const Scenario& its_scenario)
      : scenario(its_scenario), devices(BenchOf(scenario).make_devices(scenario)), bench(devices->Devices()) {
    options.log = &log;
  }
  DrivenTwin(const DrivenTwin&) = delete;
  DrivenTwin& operator=(const DrivenTwin&) = delete;

  void Drive() { DriveOn(bench); }
  void DriveOn(MachineBench other) { BenchOf(scenario).drive(other, scenario, log, {}, options); }
  /// In which that ends; "": it was carried out.
  std::string Fault() { return FaultOn(bench); }
  std::string FaultOn(MachineBench other) {
    const std::optional<DeviceFault> fault = FaultOf([&] { DriveOn(other); });
    if (fault) said = fault->what();
    return fault ? FaultName(fault->kind()) : "";
  }

  const Scenario scenario;
  const std::unique_ptr<MachineDevices> devices;
  MachineBench bench;
  MemoryLog log;
  procedure::MachineOptions options;
  std::string said;  // by the latest fault
};

/// Axes that hand on what they are asked: a test overrides what is another's.
class PassingMachine : public MachineController {
 public:
  explicit PassingMachine(MachineController& inner) : inner_(inner) {}
  const std::vector<MachineAxis>& Axes() const override { return inner_.Axes(); }
  std::vector<AxisLimits> Travel() override { return inner_.Travel(); }
  void StartMove(const std::vector<double>& to, double feed_m_s) override { inner_.StartMove(to, feed_m_s); }
  void StartArc(const Arc& arc) override { inner_.StartArc(arc); }
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override { inner_.StartTurning(axis, speed_rad_s, ramp); }
  bool Settles(Duration within) override { return inner_.Settles(within); }
  std::vector<AxisState> State() override { return inner_.State(); }
  void Stop() override { inner_.Stop(); }
  void Home() override { inner_.Home(); }

 protected:
  MachineController& inner_;
};

/// The same of instruments.
class PassingInstruments : public InstrumentSet {
 public:
  explicit PassingInstruments(InstrumentSet& inner) : inner_(inner) {}
  Reading Read() override { return inner_.Read(); }
  void Arm(int samples, int lines) override { inner_.Arm(samples, lines); }
  LatchedSamples Latched() override { return inner_.Latched(); }

 protected:
  InstrumentSet& inner_;
};

/// A bench that does not say that it is a twin, with these parts in the place of its own.
inline MachineBench AsHardware(const MachineBench& twin, MachineController& machine, InstrumentSet& instruments) {
  return {twin.clock, machine, instruments, twin.fixture, nullptr, twin.indexer};
}
inline MachineBench AsHardware(const MachineBench& twin, InstrumentSet& instruments) {
  return AsHardware(twin, twin.machine, instruments);
}
inline MachineBench AsHardware(const MachineBench& twin) { return AsHardware(twin, twin.machine, twin.instruments); }

}  // namespace twinbench::test
