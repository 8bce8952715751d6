#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/machine.h"
#include "twin/core/scenario.h"

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

}  // namespace twinbench::test
