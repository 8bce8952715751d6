#include "twin/campaign/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "twin/benches/registry.h"
#include "twin/core/kept_readings.h"
#include "twin/core/last_answer.h"
#include "twin/report/evaluation.h"
#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/standards.h"

namespace twinbench::campaign {
namespace {

using ScoredValues = std::vector<report::ScoredValue>;

std::vector<TrialResult> ResultsOf(const ScoredValues& values) {
  std::vector<TrialResult> results;
  for (const report::ScoredValue& v : values)
    results.push_back({"score." + v.name, v.value, v.u, v.value - v.truth, uncertainty::CoverageFactor(v.dof)});
  return results;
}

/// The same with what the scenario's standards add to the uncertainty of each.
std::vector<TrialResult> WithStandards(const Scenario& scenario, const std::function<ScoredValues(const Scenario&)>& score) {
  std::vector<TrialResult> results;
  const uncertainty::Evaluate evaluate = [&](const Scenario& changed) {
    const ScoredValues values = score(changed);
    if (results.empty()) results = ResultsOf(values);  // the first are those of the scenario as it stands
    std::vector<uncertainty::Quantity> quantities;
    for (const report::ScoredValue& v : values) quantities.push_back({"score." + v.name, v.value, v.u, v.dof});
    return quantities;
  };
  const std::vector<uncertainty::Budget> budgets = uncertainty::Budgets(scenario, evaluate);
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].u = budgets[i].u;
    results[i].k = budgets[i].k;
  }
  return results;
}

/// Which causes, how probable and how large, beside the other numbers; several of one effect and place by their order.
void AddCauses(const std::vector<diagnose::Cause>& causes, TrialRow& row) {
  std::map<std::string, int> told;
  for (const diagnose::Cause& cause : causes) {
    const std::string of_place = cause.where.empty() ? cause.effect : cause.effect + " " + cause.where;
    const std::string name = fmt::format("diagnosis.{}[{}].", of_place, told[of_place]++);
    row.results.push_back({name + "probability", cause.probability, kNaN, kNaN});
    for (const diagnose::ParameterEstimate& p : cause.parameters)
      row.results.push_back({name + p.name + (p.unit == "1" ? "" : "_" + p.unit), p.value / p.to_SI, p.u / p.to_SI, kNaN});
  }
}

/// @param believed  By evaluation and diagnosis; what a study hides is in `scenario` alone.
void CarryOut(const Study& study, const Scenario& scenario, const Scenario& believed, TrialRow& row) {
  const Bench& bench = BenchOf(scenario);
  const auto twin = bench.make_twin(scenario);
  KeptReadings kept;
  twin->CarryOut(kept, {});
  const std::vector<Reading> readings = kept.Take();
  const report::Evaluation evaluation = bench.evaluate(believed, readings, study.estimator);
  for (const uncertainty::Quantity& q : uncertainty::StatedQuantities(evaluation.results))
    row.results.push_back({q.name, q.value, q.u, kNaN});
  if (evaluation.Separated()) {
    const nlohmann::json truth = twin->Truth();
    const auto score = [&](const Scenario& changed) {
      const bool is_analysed = evaluation.score && &changed == &believed;
      return is_analysed ? evaluation.score(truth).values : bench.score(changed, readings, truth, study.estimator).values;
    };
    const std::vector<TrialResult> scored = study.standards ? WithStandards(believed, score) : ResultsOf(score(believed));
    row.results.insert(row.results.end(), scored.begin(), scored.end());
  }
  if (study.diagnosis) {
    const diagnose::Diagnosis found = diagnose::Diagnose(readings, believed).diagnosis;
    row.verdict = diagnose::VerdictName(found.verdict);
    AddCauses(found.causes, row);
  }
  std::ranges::stable_sort(row.results, {}, &TrialResult::name);
}

Scenario Drawn(const Study& study, Scenario scenario, std::int64_t trial) {
  return study.standards ? uncertainty::StandardsDrawn(std::move(scenario), study.seed, trial) : scenario;
}

/// What evaluation and diagnosis believe. Where nothing varies but the seed, the scenario is read once for all trials.
Scenario Believed(const Study& study, const Design& design, std::int64_t trial) {
  if (!study.vary.empty()) return study.With(design.BelievedOf(trial));
  using Text = std::tuple<std::string, std::string, std::vector<std::string>>;
  static LastAnswer<Text, Scenario> base;
  Scenario scenario = *base.To(Text(study.scenario_text, study.scenario_folder, study.set), [&] { return study.With({}); });
  scenario.seed = design.SeedOf(trial);
  return scenario;
}

bool HidesNothing(const Study& study) {
  return std::ranges::none_of(study.vary, &Variation::hidden);
}

}  // namespace

Scenario TwinOf(const Study& study, const Design& design, std::int64_t trial) {
  return Drawn(study, study.With(design.OverridesOf(trial)), trial);
}

TrialRow RunTrial(const Study& study, const Design& design, std::int64_t trial) {
  TrialRow row;
  row.trial = trial;
  try {
    const Scenario believed = Believed(study, design, trial);
    CarryOut(study, HidesNothing(study) ? Drawn(study, believed, trial) : TwinOf(study, design, trial), believed, row);
  } catch (const std::exception& error) {
    row.failure = error.what();
    row.results.clear();
  }
  return row;
}

}  // namespace twinbench::campaign
