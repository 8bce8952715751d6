#pragma once

#include <string>

#include "twin/benches/rotary_4dof/format.h"
#include "twin/core/bench.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"
#include "twin/report/evaluation.h"

/// What can be done with the bench; the fields of Bench say what each is.
namespace twinbench::benches::rotary {

const Bench& Whole();  // constant

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator);
report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator);
separate::IndexErrors IndexErrorsOf(const Scenario& scenario, const std::vector<Reading>& readings);
diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options);
std::vector<plan::NextRun> NextRunsOf(const Scenario& scenario);
diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator);
std::vector<uncertainty::Contribution> Contributions(const Scenario& scenario);
nlohmann::json ChangeOfTables(const diagnose::DiagnosisRun& found, const Scenario& scenario);

/// What would split two causes that a run cannot tell apart, in words; empty if nothing is known.
std::string NextMeasurement(const std::string& effect, const std::string& rival);

}  // namespace twinbench::benches::rotary
