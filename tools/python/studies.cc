#include "tools/python/parts.h"

#include <pybind11/stl.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/python/interrupt.h"
#include "tools/python/json_values.h"
#include "tools/python/readings.h"
#include "tools/twinbench/bench_means.h"
#include "tools/twinbench/campaign_table.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/planning.h"
#include "twin/benches/registry.h"
#include "twin/campaign/campaign.h"
#include "twin/core/errors.h"
#include "twin/investigate/hidden_run.h"
#include "twin/investigate/investigation.h"
#include "twin/investigate/json.h"

namespace twinbench::python {
namespace {

namespace py = pybind11;

py::tuple Plan(const Scenario& scenario, int setups, double minutes, double readings, const std::string& goal) {
  const tools::PlanMade made = [&] {
    py::gil_scoped_release unlocked;
    return tools::MakePlan(scenario, {setups, minutes, readings, goal});
  }();
  return py::make_tuple(ValueOf(made.json), made.next);
}

/// Ctrl-C ends it between two trials; those that are done are in the table.
/// @return the table as CSV, what the command prints, and what it answers to programs.
py::tuple Campaign(const std::string& path, const std::string& table_path, int threads, bool resume) {
  py::gil_scoped_release unlocked;
  const campaign::Study study = campaign::LoadStudy(path);
  campaign::Table table = tools::OpenTable(table_path, study, resume);
  campaign::Ranks alone(false);
  campaign::RunCampaign(study, table, threads, alone, [](const campaign::CampaignProgress&) { HearInterrupt(); });
  const campaign::Summary summary = campaign::SummaryOf(table);
  const std::string csv = table.Csv(), text = campaign::SummaryText(summary, path);
  py::gil_scoped_acquire lock;
  return py::make_tuple(csv, text, ValueOf(tools::SummaryJson(summary)));
}

/// The bench of an investigation: a twin that has something hidden, or whatever a Python function measures.
class Measured {
 public:
  Measured(const Scenario& believed, std::optional<Scenario> hidden, py::object function)
      : believed_(believed), hidden_(std::move(hidden)), function_(std::move(function)) {}

  std::vector<Reading> operator()(const investigate::Step& step, const Scenario& asked) const {
    if (hidden_) {
      std::vector<Reading> readings = tools::ReadingsOfTwin(investigate::HiddenRun(*hidden_, believed_, step.run, asked.repeat));
      HearInterrupt();
      return readings;
    }
    py::gil_scoped_acquire lock;
    const auto readings = function_(asked).cast<Readings>();
    if (readings.bench != asked.bench)
      throw InputError("measure", "gave readings of " + readings.bench, "readings of " + asked.bench);
    return readings.readings;
  }
  /// Without a hand at the bench.
  bool CanMake(const plan::NextRun& run) const { return hidden_ || investigate::IsProcedureAlone(run); }

 private:
  const Scenario& believed_;
  std::optional<Scenario> hidden_;
  py::object function_;
};

/// @return investigation.json, and the scenario with what was told.
py::tuple Investigate(const Scenario& scenario, const std::optional<Scenario>& hidden, const py::object& measure,
                      const std::string& goal, double budget_min, double conclusive, int most_runs,
                      const std::string& cache_folder) {
  const Measured bench(scenario, hidden, measure);
  investigate::InvestigationOptions how;
  if (!goal.empty()) how.goal = investigate::ParseGoal(goal);
  how.budget_min = budget_min;
  how.conclusive = conclusive;
  how.most_runs = most_runs;
  diagnose::DiagnoseOptions diagnosed;
  diagnosed.cache_folder = cache_folder;
  const auto [told, extended] = [&] {
    py::gil_scoped_release unlocked;
    const investigate::Means means =
        tools::MeansOf(BenchOf(scenario), [&bench](const plan::NextRun& run) { return bench.CanMake(run); }, diagnosed);
    investigate::Laboratory laboratory;
    laboratory.measure = std::cref(bench);
    const investigate::Investigation found = investigate::Investigate(scenario, how, means, laboratory);
    return std::pair(investigate::ToJson(found, scenario.bench), investigate::Extended(scenario, found));
  }();
  return py::make_tuple(ValueOf(told), extended);
}

}  // namespace

void AddStudies(py::module_& m) {
  m.def("plan", &Plan, py::arg("scenario"), py::arg("setups"), py::arg("minutes"), py::arg("readings"), py::arg("goal"));
  m.def("campaign", &Campaign, py::arg("study"), py::arg("table"), py::arg("threads"), py::arg("resume"));
  m.def("investigate", &Investigate, py::arg("scenario"), py::arg("hidden"), py::arg("measure"), py::arg("goal"),
        py::arg("budget_min"), py::arg("conclusive"), py::arg("most_runs"), py::arg("cache_folder"));
}

}  // namespace twinbench::python
