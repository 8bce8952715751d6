#include "tools/twinbench/evaluation.h"

#include "tools/twinbench/bench_results.h"

namespace twinbench::tools {

Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, measure::Estimator estimator) {
  if (scenario.bench == kEncoderBench) return EvaluateEncoder(scenario, readings);
  if (scenario.bench == kTurntableBench) return EvaluateTurntable(scenario, readings, estimator);
  if (scenario.bench == kHobBench) return EvaluateHob(scenario, readings, estimator);
  return EvaluateRotary(scenario, readings, estimator);
}

ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings, const nlohmann::json& truth,
                   measure::Estimator estimator) {
  if (scenario.bench == kTurntableBench) return ScoreTurntable(scenario, readings, truth, estimator);
  if (scenario.bench == kHobBench) return ScoreHob(scenario, readings, truth, estimator);
  if (scenario.bench == kEncoderBench) return ScoreEncoder(readings, truth);
  return ScoreRotary(scenario, readings, truth, estimator);
}

}  // namespace twinbench::tools
