#pragma once

#include <string>
#include <vector>

#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/run_folder.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {

/// What every run's results.json holds, and what is printed of it.
struct EvaluatedRun {
  report::Evaluation evaluation;  // with `uncertainty_budget` among its results
  std::string text;               // the budget too where the scenario says how well its constants are known
};

EvaluatedRun EvaluatedWithBudget(const Scenario& scenario, const std::vector<Reading>& readings);

/// Evaluates a finished run from its record, as any later look at it will, writes results.json, prints the summary and answers with both.
/// @return whether there was enough to separate the tables.
/// @throws InputError after all that, if a fit does not describe the readings.
bool EvaluateRun(const Scenario& scenario, const std::string& folder, JsonAnswer& answer);

/// What a command that makes a run answers: {"run", "bench", "title", "seed", "readings", "readings_ok", "separated", "results"}, the last as
/// in results.json; "not_separated" says why, where it is not.
nlohmann::json RunJson(const RunFolder& folder, const Scenario& scenario, const std::vector<Reading>& readings, const EvaluatedRun& run);

/// The same of readings that were measured.
/// @throws InputError if none of them is usable.
void EvaluateMeasured(const Scenario& scenario, const std::string& folder, JsonAnswer& answer);

}  // namespace twinbench::tools
