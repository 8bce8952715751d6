#pragma once

#include <vector>

#include "twin/core/bench.h"
#include "twin/core/estimator.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

/// Results as they may be told, of any bench: the ways from readings to somebody who reads a number.
namespace twinbench {

/// What the scenario's bench makes of the readings, without what is no result (report::KeepSound).
report::Evaluation EvaluationOf(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator);

/// The same against its truth.
/// @throws InputError if there is nothing to compare, or if the fit does not describe the readings.
report::ScoredRun ScoreOf(const Scenario& scenario, const std::vector<Reading>& readings, const nlohmann::json& truth,
                          Estimator estimator);

}  // namespace twinbench
