#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

/// As Bench::evaluate and Bench::score, of a run with a polygon.
namespace twinbench::benches::turntable {

report::Evaluation EvaluatePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                                   Estimator estimator);
report::ScoredRun ScorePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                               const nlohmann::json& truth, Estimator estimator);

}  // namespace twinbench::benches::turntable
