#include "twin/benches/evaluated.h"

#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/report/sound.h"

namespace twinbench {

report::Evaluation EvaluationOf(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  report::Evaluation evaluation = BenchOf(scenario).evaluate(scenario, readings, estimator);
  report::KeepSound(readings, evaluation);
  return evaluation;
}

report::ScoredRun ScoreOf(const Scenario& scenario, const std::vector<Reading>& readings, const nlohmann::json& truth,
                          Estimator estimator) {
  const report::Evaluation evaluation = EvaluationOf(scenario, readings, estimator);
  if (evaluation.IsRefuted()) throw InputError("the run", evaluation.not_separated, report::WhatItWouldTake(evaluation));
  report::ScoredRun score = evaluation.score ? evaluation.score(truth) : BenchOf(scenario).score(scenario, readings, truth, estimator);
  score.text = report::WithoutNoNumbers(score.text);
  score.positions = report::WithoutNoNumbers(score.positions);
  return score;
}

}  // namespace twinbench
