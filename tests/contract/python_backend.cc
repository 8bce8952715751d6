#include "tests/contract/rotary_bench.h"

#ifdef TWINBENCH_PYTHON_TESTS
#include <pybind11/embed.h>

#include "tools/python/own_bench.h"
#endif

namespace twinbench::test {

#ifdef TWINBENCH_PYTHON_TESTS
namespace {

namespace py = pybind11;

/// One interpreter for the whole program: numpy does not stand a second one.
void NeedInterpreter() { static const py::scoped_interpreter interpreter; }

py::object ClosedFormBench(const Scenario& scenario) {
  NeedInterpreter();
  return py::module_::import("closed_form_bench").attr("ClosedFormBench")(WriteScenario(scenario));
}

class LivingPythonBench : public LivingBench {
 public:
  explicit LivingPythonBench(const Scenario& scenario) : own_(ClosedFormBench(scenario)) {}
  RotaryBench Bench() override { return own_.Bench(); }

 private:
  python::OwnRotaryBench own_;
};

}  // namespace

BenchBackend PythonBackend() {
  const auto make = [](const Scenario& scenario) -> std::unique_ptr<LivingBench> {
    return std::make_unique<LivingPythonBench>(scenario);
  };
  return {"Python", make, true, false};
}
#else
BenchBackend PythonBackend() { return {"Python", {}, true, false, "the Python package was not built"}; }
#endif

}  // namespace twinbench::test
