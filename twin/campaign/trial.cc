#include "twin/campaign/trial.h"

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "twin/benches/registry.h"
#include "twin/core/run_record.h"
#include "twin/procedure/options.h"
#include "twin/report/evaluation.h"
#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/standards.h"

namespace twinbench::campaign {
namespace {

std::vector<TrialResult> Scored(const Bench& bench, const Scenario& scenario, const std::vector<Reading>& readings,
                                const nlohmann::json& truth, Estimator estimator) {
  std::vector<TrialResult> results;
  for (const report::ScoredValue& v : bench.score(scenario, readings, truth, estimator).values)
    results.push_back({"score." + v.name, v.value, v.u, v.value - v.truth, uncertainty::CoverageFactor(v.dof)});
  return results;
}

/// The same with what the scenario's standards add to the uncertainty of each.
std::vector<TrialResult> ScoredWithStandards(const Bench& bench, const Scenario& scenario,
                                             const std::vector<Reading>& readings, const nlohmann::json& truth,
                                             Estimator estimator) {
  std::vector<TrialResult> results = Scored(bench, scenario, readings, truth, estimator);
  const uncertainty::Evaluate evaluate = [&](const Scenario& changed) {
    std::vector<uncertainty::Quantity> quantities;
    for (const report::ScoredValue& v : bench.score(changed, readings, truth, estimator).values)
      quantities.push_back({"score." + v.name, v.value, v.u, v.dof});
    return quantities;
  };
  const std::vector<uncertainty::Budget> budgets = uncertainty::Budgets(scenario, evaluate);
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].u = budgets[i].u;
    results[i].k = budgets[i].k;
  }
  return results;
}

/// @param believed  By evaluation and diagnosis; what a study hides is in `scenario` alone.
void CarryOut(const Study& study, const Scenario& scenario, const Scenario& believed, TrialRow& row) {
  const Bench& bench = BenchOf(scenario);
  const auto twin = bench.make_twin(scenario);
  const auto record = RunRecord::CreateInMemory({"", "twin", scenario.seed, "", scenario.bench});
  twin->CarryOut(*record, [](const procedure::Progress&) {});
  const std::vector<Reading> readings = record->Readings();
  const report::Evaluation evaluation = bench.evaluate(believed, readings, study.estimator);
  for (const uncertainty::Quantity& q : uncertainty::StatedQuantities(evaluation.results))
    row.results.push_back({q.name, q.value, q.u, kNaN});
  if (evaluation.Separated()) {
    const auto score = study.standards ? ScoredWithStandards : Scored;
    const std::vector<TrialResult> scored = score(bench, believed, readings, twin->Truth(), study.estimator);
    row.results.insert(row.results.end(), scored.begin(), scored.end());
  }
  std::ranges::stable_sort(row.results, {}, &TrialResult::name);
  if (study.diagnosis)
    row.verdict = diagnose::VerdictName(diagnose::Diagnose(readings, believed).diagnosis.verdict);
}

}  // namespace

Scenario TwinOf(const Study& study, const Design& design, std::int64_t trial) {
  Scenario scenario = study.With(design.OverridesOf(trial));
  return study.standards ? uncertainty::StandardsDrawn(std::move(scenario), study.seed, trial) : scenario;
}

TrialRow RunTrial(const Study& study, const Design& design, std::int64_t trial) {
  TrialRow row;
  row.trial = trial;
  try {
    CarryOut(study, TwinOf(study, design, trial), study.With(design.BelievedOf(trial)), row);
  } catch (const std::exception& error) {
    row.failure = error.what();
    row.results.clear();
  }
  return row;
}

}  // namespace twinbench::campaign
