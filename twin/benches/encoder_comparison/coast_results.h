#pragma once

#include <vector>

#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

/// Runs in which a spindle coasts and the times of the ring's lines are read.
namespace twinbench::benches::encoder {

report::Evaluation EvaluateCoast(const Scenario& scenario, const std::vector<Reading>& readings,
                                 Estimator estimator);

/// @throws InputError if the readings give no curve.
report::ScoredRun ScoreCoast(const std::vector<Reading>& readings, const nlohmann::json& truth,
                             Estimator estimator);

}  // namespace twinbench::benches::encoder
