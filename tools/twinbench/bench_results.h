#pragma once

#include "tools/twinbench/evaluation.h"

/// The same for one kind of bench each; evaluation.cc chooses.
namespace twinbench::tools {

Evaluation EvaluateRotary(const Scenario&, const std::vector<Reading>&, measure::Estimator);
Evaluation EvaluateEncoder(const Scenario&, const std::vector<Reading>&);
Evaluation EvaluateTurntable(const Scenario&, const std::vector<Reading>&, measure::Estimator);
Evaluation EvaluateHob(const Scenario&, const std::vector<Reading>&, measure::Estimator);

ScoredRun ScoreRotary(const Scenario&, const std::vector<Reading>&, const nlohmann::json& truth,
                      measure::Estimator);
ScoredRun ScoreEncoder(const std::vector<Reading>&, const nlohmann::json& truth);
ScoredRun ScoreTurntable(const Scenario&, const std::vector<Reading>&, const nlohmann::json& truth,
                         measure::Estimator);
ScoredRun ScoreHob(const Scenario&, const std::vector<Reading>&, const nlohmann::json& truth, measure::Estimator);

}  // namespace twinbench::tools
