#pragma once

#include <functional>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"

/// A diagnosis is judged by the scenario that it writes, not by the fit that found it: what the file does not show
/// was not gained.
namespace twinbench::diagnose {

/// Readings against a scenario's twin: Bench::linear_run.
using AgainstScenario =
    std::function<LinearRun(const std::vector<Reading>& readings, const Scenario& scenario, Estimator model)>;

/// Writes extended.toml, reads it back, follows the readings with it and states its gain (gain.h). A cause whose
/// gain is not above zero at 95 % is no more than a proposal; what the file shows less than the fit is said in a
/// note. A file that the bench refuses is said as well: then the gain is that of the fit.
void JudgeByFile(const std::vector<Reading>& readings, const Scenario& scenario, const DiagnoseOptions& options,
                 const AgainstScenario& against, DiagnosisRun& result);

}  // namespace twinbench::diagnose
