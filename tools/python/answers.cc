#include "tools/twinbench/answers.h"

#include <pybind11/stl.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/python/interrupt.h"
#include "tools/python/json_values.h"
#include "tools/python/parts.h"
#include "tools/python/readings.h"
#include "tools/twinbench/evaluated_run.h"
#include "twin/benches/evaluated.h"
#include "twin/benches/expected.h"
#include "twin/core/estimator.h"
#include "twin/core/run_record.h"

namespace twinbench::python {
namespace {

namespace py = pybind11;

/// In messages.
constexpr const char* kTheRun = "the run";

/// Computed while other threads of Python may run.
template <class Compute>
auto Unlocked(Compute compute) {
  const py::gil_scoped_release unlocked;
  return compute();
}

tools::RecordedRun RunOf(const Scenario& scenario, const Readings& r) {
  return {scenario, r.readings};
}

/// JSON and text of an answer.
py::tuple Pair(const tools::Answer& answer) {
  return py::make_tuple(ValueOf(answer.json), answer.text);
}

py::tuple Evaluate(const Scenario& scenario, const Readings& r) {
  const tools::EvaluatedRun run = Unlocked([&] { return tools::EvaluatedWithBudget(scenario, r.readings); });
  return py::make_tuple(ValueOf(run.evaluation.results), run.text);
}

std::vector<std::string> Doubts(const Scenario& scenario, const Readings& r) {
  const std::vector<plausible::Finding> findings = Unlocked([&] { return DoubtsAbout(r.readings, scenario); });
  plausible::RefuseFatal(findings, kTheRun);
  std::vector<std::string> lines;
  for (const plausible::Finding& finding : findings) lines.push_back(finding.line);
  return lines;
}

py::object Score(const Scenario& scenario, const Readings& r, const py::object& truth,
                 const std::string& estimator) {
  return ValueOf(tools::ScoreJson(ScoreOf(scenario, r.readings, JsonOf(truth), EstimatorNamed(estimator))));
}

py::tuple Uncertainty(const Scenario& scenario, const Readings& r, const std::string& estimator, int trials,
                      std::uint64_t seed, int threads) {
  uncertainty::MonteCarloOptions how;
  how.most_trials = trials, how.seed = seed, how.threads = threads;
  return Pair(Unlocked(
      [&] { return tools::UncertaintyOf(RunOf(scenario, r), kTheRun, estimator, trials > 0 ? &how : nullptr); }));
}

py::tuple Budget(const Scenario& scenario, const std::string& of) {
  return Pair(Unlocked([&] { return tools::BudgetOf(scenario, scenario.title, of, HearInterrupt); }));
}

py::tuple Compensate(const std::string& source, const Scenario& scenario, const Readings& r,
                     const std::string& form, const std::string& axis, int points, int highest_order) {
  tools::CompensationWish wish{form, axis, {}};
  wish.how.points = points, wish.how.search.highest_order = highest_order;
  const tools::CompensationMade made =
      Unlocked([&] { return tools::CompensationOf(RunOf(scenario, r), source, wish); });
  return py::make_tuple(ValueOf(made.json), made.text, made.table);
}

/// @return where the readings are from, beside them.
py::tuple Load(const std::string& source, const std::string& scenario) {
  tools::RecordedRun run = tools::LoadRecordedRun(source, scenario, {});
  const bool is_folder = std::filesystem::is_directory(source);
  const std::string from = is_folder ? RunRecord::Open(source)->provenance().source : "import: " + source;
  Readings readings{run.scenario.bench, std::move(run.readings)};
  return py::make_tuple(std::move(run.scenario), std::move(readings), from);
}

/// As `run` leaves it.
void Save(const std::string& folder, const std::string& from, const Scenario& scenario, const Readings& r,
          const py::object& truth) {
  const nlohmann::json truth_json = truth.is_none() ? nlohmann::json() : JsonOf(truth);
  Unlocked([&] {
    const tools::EvaluatedRun run = tools::EvaluatedWithBudget(scenario, r.readings);
    tools::WriteRun({folder}, from, RunOf(scenario, r), run.evaluation.results, truth_json);
    tools::WriteTables(folder, run.evaluation.tables);
  });
}

py::object Truth(const std::string& folder) {
  const tools::RunFolder run{folder};
  return std::filesystem::exists(run.truth()) ? ValueOf(tools::ReadJson(run.truth())) : py::none();
}

py::tuple Import(const std::vector<std::string>& files, const std::string& scenario, const std::string& map,
                 const std::vector<std::string>& overrides, const std::vector<std::string>& columns,
                 int most_readings) {
  tools::Imported taken = Unlocked([&] {
    return tools::ImportedFrom({files, scenario, map, overrides, columns, most_readings});
  });
  Readings readings{taken.scenario.bench, std::move(taken.readings)};
  return py::make_tuple(std::move(taken.scenario), std::move(readings), taken.story);
}

}  // namespace

void AddAnswers(py::module_& m) {
  m.def("load_run", &Load);
  m.def("truth_of", &Truth);
  m.def("save_run", &Save);
  m.def("import_recording", &Import);
  m.def("evaluate", &Evaluate);
  m.def("doubts", &Doubts);
  m.def("score", &Score);
  m.def("uncertainty", &Uncertainty);
  m.def("budget", &Budget);
  m.def("compensate", &Compensate);
  m.def("certificate", [](const std::string& run, const std::string& laboratory, const std::string& file) {
    return Pair(tools::CertificateOf(run, laboratory, file));
  });
  m.def("write_report", &tools::WriteReport, py::call_guard<py::gil_scoped_release>());
}

}  // namespace twinbench::python
