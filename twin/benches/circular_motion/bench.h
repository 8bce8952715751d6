#pragma once

#include "twin/benches/circular_motion/format.h"
#include "twin/core/bench.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"
#include "twin/report/evaluation.h"

/// What can be done with the bench; the fields of Bench say what each is.
namespace twinbench::benches::circular {

struct CircleAnalysis;

const Bench& Whole();  // constant

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator);
/// The same of readings that have been analysed.
report::ScoredRun ScoreOf(const CircleAnalysis& analysis, const nlohmann::json& truth);
report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator);
diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options);
std::vector<plan::NextRun> NextRunsOf(const Scenario& scenario);
diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator);

}  // namespace twinbench::benches::circular
