#pragma once

#include <vector>

#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

/// Runs in which several heads read the ring.
namespace twinbench::benches::encoder {

report::Evaluation EvaluateHeads(const Scenario& scenario, const std::vector<Reading>& readings,
                                 Estimator estimator);

/// Orders that no head tells are taken out of the truth; how large they were is said beside it.
/// @throws InputError if the readings give no curve.
report::ScoredRun ScoreHeads(const Scenario& scenario, const std::vector<Reading>& readings,
                             const nlohmann::json& truth, Estimator estimator);

}  // namespace twinbench::benches::encoder
