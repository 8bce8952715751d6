#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "twin/core/machine.h"
#include "twin/core/scenario.h"

namespace twinbench::test {

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
