#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/python/interrupt.h"
#include "tools/python/json_values.h"
#include "tools/python/own_bench.h"
#include "tools/python/own_machine.h"
#include "tools/python/parts.h"
#include "tools/python/readings.h"
#include "twin/benches/diagnosis_json.h"
#include "twin/benches/encoder_comparison/procedure.h"
#include "twin/benches/evaluated.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/core/run_record.h"
#include "twin/core/side_by_side.h"
#include "twin/diagnose/extend.h"
#include "twin/model/follow.h"
#include "twin/procedure/machine_options.h"
#include "twin/report/evaluation.h"
#include "twin/separate/error_motion.h"

// The compiled half of the package; what users call, with docstrings, is in twinbench/*.py.
namespace twinbench::python {
namespace {

namespace py = pybind11;

void Interrupted(const procedure::Progress& /*progress*/) {
  HearInterrupt();
}

std::unique_ptr<RunRecord> NewRecord(const Scenario& scenario, const char* backend) {
  return RunRecord::CreateInMemory({TWINBENCH_VERSION, backend, scenario.seed, "", scenario.bench});
}

struct TwinRun {
  Readings readings;
  nlohmann::json truth;
};

TwinRun RunTwin(const Scenario& scenario) {
  const std::unique_ptr<BenchTwin> twin = BenchOf(scenario).make_twin(scenario);
  const auto record = NewRecord(scenario, "twin");
  twin->CarryOut(*record, Interrupted);
  return {{scenario.bench, record->Readings()}, twin->Truth()};
}

void RequireSameBench(const py::object& bench, const Scenario& scenario) {
  const std::string own = py::str(py::getattr(bench, "bench", py::str("none"))).cast<std::string>();
  if (own != scenario.bench)
    throw InputError("drive", "the scenario is of " + scenario.bench + ", the Python bench of " + own,
                     "a twinbench.RotaryBench, twinbench.MachineBench or twinbench.AngleBench, and a scenario of its kind");
}

/// The procedure of the scenario on a bench of somebody's own.
Readings Drive(const py::object& bench, const Scenario& scenario) {
  RequireSameBench(bench, scenario);
  const auto record = NewRecord(scenario, "python");
  if (py::hasattr(bench, "take")) {
    OwnAngleComparator own(bench);
    py::gil_scoped_release unlocked;
    procedure::CarryOut(own, scenario, *record, Interrupted);
  } else if (py::hasattr(bench, "start_arc")) {
    OwnMachineBench own(bench, scenario);
    py::gil_scoped_release unlocked;
    MachineBench devices = own.Devices();
    BenchOf(scenario).drive(devices, scenario, *record, Interrupted, {});
  } else {
    OwnRotaryBench own(bench);
    py::gil_scoped_release unlocked;
    RotaryBench devices = own.Bench();
    procedure::CarryOut(devices, scenario, *record, Interrupted);
  }
  return {scenario.bench, record->Readings()};
}

/// (name, is rotary) of each axis, (lower, upper) of each with None where there is no limit, where they begin, columns of the instruments.
py::tuple PartsForPython(const Scenario& scenario) {
  const MachineParts parts = PartsOf(scenario);
  const auto limit = [](double at) { return std::isfinite(at) ? py::object(py::float_(at)) : py::object(py::none()); };
  py::list axes, travel;
  for (const MachineAxis& axis : parts.axes) axes.append(py::make_tuple(axis.name, axis.is_rotary));
  for (const AxisLimits& axis : parts.travel) travel.append(py::make_tuple(limit(axis.lower), limit(axis.upper)));
  return py::make_tuple(axes, travel, parts.start, parts.columns);
}

report::Evaluation Separated(const Scenario& scenario, const Readings& r, const std::string& estimator) {
  report::Evaluation evaluation = EvaluationOf(scenario, r.readings, EstimatorNamed(estimator));
  if (!evaluation.Separated())
    throw InputError("the readings", evaluation.not_separated, "readings of a full-circle test");
  return evaluation;
}

struct Diagnosed {
  nlohmann::json json;
  std::string extended_toml;
};

Diagnosed DiagnosedBy(const Scenario& scenario, const Readings& r, const std::string& model,
                      const std::vector<std::string>& excluded, const std::string& cache_folder) {
  diagnose::DiagnoseOptions options;
  options.model = EstimatorNamed(model);
  options.excluded = excluded;
  options.cache_folder = cache_folder;
  options.threads = ProcessorCount();
  const diagnose::DiagnosisRun found = diagnose::Diagnose(r.readings, scenario, options);
  return {DiagnosisJson(found, scenario, ""),
          diagnose::ExtendedToml(scenario, found, "twinbench " TWINBENCH_VERSION ", Python")};
}

std::string CsvOf(const Readings& r) {
  std::ostringstream text;
  WriteReadingsCsv(r.readings, r.bench, text);
  return text.str();
}

Readings FromCsv(const std::string& text, const std::string& name, const std::string& bench) {
  std::istringstream in(text);
  return {bench, ParseReadingsCsv(in, name, bench)};
}

/// {"synchronous": {"value", "u", "bias"}, ...} of what is known.
py::dict ErrorMotionOf(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& turns, bool is_axial) {
  if (angle_rad.size() < 3 || turns.cols() != angle_rad.size() || turns.rows() < 1)
    throw InputError("error_motion", fmt::format("{} angles and turns of {} x {}", angle_rad.size(), turns.rows(), turns.cols()),
                     "three angles or more and turns x angles values");
  if (!angle_rad.allFinite() || !turns.allFinite()) throw InputError("error_motion", "not all is finite", "numbers");
  const separate::ErrorMotionValues found = separate::EvaluateErrorMotion(
      separate::OfTurns(angle_rad, turns), is_axial ? separate::PlotCentre::kPolarChart : separate::PlotCentre::kLeastSquares);
  py::dict values;
  const auto add = [&](const char* name, const separate::ErrorMotionValue& v) {
    if (std::isfinite(v.value)) values[name] = py::dict(py::arg("value") = v.value, py::arg("u") = v.u, py::arg("bias") = v.bias);
  };
  add("total", found.total);
  add("synchronous", found.synchronous);
  add("asynchronous", found.asynchronous);
  add("fundamental", found.fundamental);
  add("residual", found.residual);
  return values;
}

void AddScenario(py::module_& m) {
  py::class_<Scenario>(m, "Scenario")
      .def_static("load", &LoadScenario, py::arg("path"), py::arg("overrides") = std::vector<std::string>())
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name, const std::string& folder) {
            return ParseScenario(text, name, folder);
          },
          py::arg("text"), py::arg("name") = "scenario", py::arg("folder") = ".")
      .def("altered", &Altered, py::arg("overrides"))
      .def("toml", &WriteScenario)
      .def_readonly("bench", &Scenario::bench)
      .def_readonly("title", &Scenario::title)
      .def_readonly("seed", &Scenario::seed);
}

void AddReadings(py::module_& m) {
  py::class_<Readings>(m, "Readings")
      .def_static("from_csv_text", &FromCsv, py::arg("text"), py::arg("name"), py::arg("bench"))
      .def("csv_text", &CsvOf)
      .def("columns", [](const Readings& r) { return ColumnsOf(r.readings, r.bench); })
      .def("__len__", [](const Readings& r) { return r.readings.size(); })
      .def_readonly("bench", &Readings::bench);
}

void AddFunctions(py::module_& m) {
  m.def("run_twin", [](const Scenario& scenario) {
    const TwinRun run = [&] {
      py::gil_scoped_release unlocked;
      return RunTwin(scenario);
    }();
    return py::make_tuple(run.readings, ValueOf(run.truth));
  });
  m.def("drive", &Drive, py::arg("bench"), py::arg("scenario"));
  m.def("machine_parts", &PartsForPython, py::arg("scenario"));
  m.def("error_motion", &ErrorMotionOf, py::arg("angle_rad"), py::arg("turns"), py::arg("is_axial"));
  m.def("separate", [](const Scenario& scenario, const Readings& r, const std::string& estimator) {
    const report::Evaluation evaluation = [&] {
      py::gil_scoped_release unlocked;
      return Separated(scenario, r, estimator);
    }();
    return ValueOf(evaluation.separation);
  });
  m.def("diagnose", [](const Scenario& scenario, const Readings& r, const std::string& model,
                       const std::vector<std::string>& excluded, const std::string& cache_folder) {
    const Diagnosed diagnosed = [&] {
      py::gil_scoped_release unlocked;
      return DiagnosedBy(scenario, r, model, excluded, cache_folder);
    }();
    return py::make_tuple(ValueOf(diagnosed.json), diagnosed.extended_toml);
  });
  m.def(
      "follow",
      [](const Scenario& scenario, const Readings& r) { return BenchOf(scenario).follow(scenario, r.readings); },
      py::call_guard<py::gil_scoped_release>());
}

}  // namespace
}  // namespace twinbench::python

PYBIND11_MODULE(_core, m) {
  using namespace twinbench::python;
  m.attr("__version__") = TWINBENCH_VERSION;
  pybind11::register_exception<twinbench::InputError>(m, "InputError", PyExc_ValueError);
  pybind11::register_exception<twinbench::BenchError>(m, "BenchError", PyExc_RuntimeError);
  AddFollow(m);
  AddScenario(m);
  AddReadings(m);
  AddFunctions(m);
  AddAnswers(m);
  AddStudies(m);
}
