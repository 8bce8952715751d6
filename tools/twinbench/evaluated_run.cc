#include "tools/twinbench/evaluated_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/twinbench/doubts.h"
#include "twin/benches/evaluated.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/core/run_record.h"
#include "twin/report/evaluation.h"
#include "twin/report/sound.h"
#include "twin/report/uncertainty_text.h"

namespace twinbench::tools {

namespace {

/// Every result with what its readings and each constant that is known only so well add to its uncertainty.
std::vector<uncertainty::Budget> BudgetsOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  return uncertainty::Budgets(scenario, [&](const Scenario& changed) {
    return uncertainty::QuantitiesOf(EvaluationOf(changed, readings, Estimator::kRigorous).results);
  });
}

/// Missing, saturated or disturbed, every one: exchanged wires, say.
void RequireAnyUsable(const std::string& folder, const std::vector<Reading>& readings) {
  const auto is_usable = [](const Reading& r) { return r.status == ReadingStatus::kOk; };
  if (readings.empty() || std::ranges::any_of(readings, is_usable)) return;
  throw InputError(folder, fmt::format("none of the {} readings is usable", readings.size()),
                   "readings with status ok: what happened to these stands in readings.csv");
}

}  // namespace

EvaluatedRun EvaluatedWithBudget(const Scenario& scenario, const std::vector<Reading>& readings) {
  EvaluatedRun run = {EvaluationOf(scenario, readings, Estimator::kRigorous), {}};
  const std::vector<uncertainty::Budget> budgets = BudgetsOf(scenario, readings);
  run.evaluation.results["uncertainty_budget"] = report::BudgetsByList(budgets);
  report::ClearNoNumbers(run.evaluation.results["uncertainty_budget"]);
  run.text = run.evaluation.summary;
  if (!scenario.uncertainties.empty()) run.text += "\n" + report::WithoutNoNumbers(report::BudgetText(budgets));
  return run;
}

nlohmann::json RunJson(const RunFolder& folder, const Scenario& scenario, const std::vector<Reading>& readings, const EvaluatedRun& run) {
  nlohmann::json json = {{"run", folder.path},
                         {"bench", scenario.bench},
                         {"title", scenario.title},
                         {"seed", scenario.seed},
                         {"readings", readings.size()},
                         {"readings_ok", std::ranges::count(readings, ReadingStatus::kOk, &Reading::status)},
                         {"separated", run.evaluation.Separated()},
                         {"results", run.evaluation.results}};
  if (!run.evaluation.Separated()) json["not_separated"] = run.evaluation.not_separated;
  return json;
}

namespace {

/// @param record  Of the folder, with these readings.
bool EvaluateRecord(const Scenario& scenario, const std::string& folder, RunRecord& record, const std::vector<Reading>& readings, JsonAnswer& answer) {
  TellDoubts(readings, scenario, folder);
  const EvaluatedRun run = EvaluatedWithBudget(scenario, readings);
  record.WriteBeside(kResultsFile, JsonText(run.evaluation.results));
  WriteTables(folder, run.evaluation.tables);
  fmt::print("{}", run.text);
  answer.Write(RunJson({folder}, scenario, readings, run));
  if (run.evaluation.IsRefuted()) throw InputError(folder, run.evaluation.not_separated, report::WhatItWouldTake(run.evaluation));
  return run.evaluation.Separated();
}

}  // namespace

bool EvaluateRun(const Scenario& scenario, const std::string& folder, JsonAnswer& answer) {
  const auto record = RunRecord::Open(folder);
  return EvaluateRecord(scenario, folder, *record, record->Readings(), answer);
}

void EvaluateMeasured(const Scenario& scenario, const std::string& folder, JsonAnswer& answer) {
  const auto record = RunRecord::Open(folder);
  const std::vector<Reading> readings = record->Readings();
  EvaluateRecord(scenario, folder, *record, readings, answer);
  RequireAnyUsable(folder, readings);
}

}  // namespace twinbench::tools
