#include "tools/twinbench/evaluated_run.h"

#include <fmt/core.h>

#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"
#include "twin/core/estimator.h"
#include "twin/core/run_record.h"
#include "twin/report/evaluation.h"
#include "twin/report/uncertainty_text.h"

namespace twinbench::tools {

namespace {

/// Every result with what its readings and each constant that is known only so well add to its uncertainty.
std::vector<uncertainty::Budget> BudgetsOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  return uncertainty::Budgets(scenario, [&](const Scenario& changed) {
    return uncertainty::QuantitiesOf(BenchOf(changed).evaluate(changed, readings, Estimator::kRigorous).results);
  });
}

}  // namespace

EvaluatedRun EvaluatedWithBudget(const Scenario& scenario, const std::vector<Reading>& readings) {
  EvaluatedRun run = {BenchOf(scenario).evaluate(scenario, readings, Estimator::kRigorous), {}};
  const std::vector<uncertainty::Budget> budgets = BudgetsOf(scenario, readings);
  run.evaluation.results["uncertainty_budget"] = report::BudgetsByList(budgets);
  run.text = run.evaluation.summary;
  if (!scenario.uncertainties.empty()) run.text += "\n" + report::BudgetText(budgets);
  return run;
}

bool EvaluateRun(const Scenario& scenario, const std::string& folder) {
  const EvaluatedRun run = EvaluatedWithBudget(scenario, RunRecord::Open(folder)->Readings());
  WriteJson(RunFolder{folder}.results(), run.evaluation.results);
  WriteTables(folder, run.evaluation.tables);
  fmt::print("{}", run.text);
  return run.evaluation.Separated();
}

}  // namespace twinbench::tools
