#include "tests/machine/benches.h"

#ifdef TWINBENCH_PYTHON_TESTS
#include <pybind11/embed.h>

#include "tools/python/own_machine.h"
#endif

namespace twinbench::test {
namespace {

#ifdef TWINBENCH_PYTHON_TESTS
namespace py = pybind11;

/// @param of  Class of own_machines.py.
AnyMachine PythonMachine(const char* of, Scenario (*scenario)()) {
  const auto make = [of](const Scenario& s) -> std::unique_ptr<MachineDevices> {
    static const py::scoped_interpreter interpreter;  // one for the whole program: numpy does not stand a second one
    const py::object package = py::module_::import("twinbench");
    const py::object its_scenario = package.attr("Scenario").attr("from_toml")(WriteScenario(s));
    return std::make_unique<python::OwnMachineBench>(py::module_::import("own_machines").attr(of)(its_scenario), s);
  };
  return {std::string("Python") + of, scenario, make};
}
#else
AnyMachine PythonMachine(const char* of, Scenario (*scenario)()) {
  return {std::string("Python") + of, scenario, {}, "the Python package was not built"};
}
#endif

}  // namespace

std::vector<AnyMachine> PythonMachinesThatAreSent() {
  return {PythonMachine("Turntable", ShortTurntable), PythonMachine("Circles", ShortCircles), PythonMachine("FiveAxes", ShortFreeform),
          PythonMachine("Shaft", ShortStops)};
}

AnyMachine PythonMachineThatTurns() { return PythonMachine("HobbingMachine", ShortHob); }

}  // namespace twinbench::test
