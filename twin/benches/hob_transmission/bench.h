#pragma once

#include <string>

#include "twin/benches/hob_transmission/format.h"
#include "twin/core/bench.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"
#include "twin/report/evaluation.h"

namespace twinbench::separate::hob {
struct HobAnalysis;
}

/// What can be done with the bench; the fields of Bench say what each is.
namespace twinbench::benches::hob {

const Bench& Whole();  // constant

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator);
/// The same of readings that have been analysed.
report::ScoredRun ScoreOf(const separate::hob::HobAnalysis& analysis, const nlohmann::json& truth);
report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator);
diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options);
std::vector<plan::NextRun> NextRunsOf(const Scenario& scenario);
plan::ShiftDesign ShiftsOf(const Scenario& scenario);
diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator);

/// What would split two causes that a run cannot tell apart, in words; empty if nothing is known.
std::string NextMeasurement(const std::string& effect, const std::string& rival);

}  // namespace twinbench::benches::hob
