#include <fmt/core.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/twinbench/answers.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/doubts.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/evaluated.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/core/side_by_side.h"
#include "twin/report/evaluation.h"
#include "twin/report/sound.h"
#include "twin/report/uncertainty_text.h"

namespace twinbench::tools {
namespace {

struct UncertaintyOptions {
  std::string source, scenario, estimator = "rigorous";
  std::vector<std::string> overrides;
  bool monte_carlo = false;
  uncertainty::MonteCarloOptions trials;
};

uncertainty::Evaluate EvaluationOf(const RecordedRun& run, const std::string& estimator) {
  const auto evaluations = std::make_shared<std::atomic<int>>(0);
  return [&run, estimator, evaluations](const Scenario& scenario) {
    Doing(fmt::format("evaluation {} of the readings, each with other constants", ++*evaluations));
    return uncertainty::QuantitiesOf(
        EvaluationOf(scenario, run.readings, EstimatorNamed(estimator)).results);
  };
}

/// What the readings leave uncertain together, of the quantities that have a budget.
std::vector<uncertainty::Joint> JointsOf(const RecordedRun& run, const std::string& estimator,
                                         const std::vector<uncertainty::Budget>& budgets) {
  std::vector<std::string> names;
  for (const uncertainty::Budget& budget : budgets) names.push_back(budget.quantity.name);
  std::vector<uncertainty::Joint> joints;
  for (const uncertainty::Joint& joint :
       EvaluationOf(run.scenario, run.readings, EstimatorNamed(estimator)).Joints())
    joints.push_back(Determined(joint, names));
  return joints;
}

void State(const UncertaintyOptions& options, JsonAnswer& answer) {
  RequireOutput(answer.to(), {options.source, options.scenario});
  const RecordedRun run = LoadPlausibleRun(options.source, options.scenario, options.overrides);
  const Answer stated = UncertaintyOf(run, options.source, options.estimator, options.monte_carlo ? &options.trials : nullptr);
  answer.Write(stated.json);
  if (!answer.IsOnStdout()) fmt::print("{}", stated.text);
}

}  // namespace

Answer UncertaintyOf(const RecordedRun& run, const std::string& source, const std::string& estimator, const uncertainty::MonteCarloOptions* how) {
  const uncertainty::Evaluate evaluate = EvaluationOf(run, estimator);
  const std::vector<uncertainty::Budget> budgets = uncertainty::Budgets(run.scenario, evaluate);
  if (budgets.empty())
    throw InputError(source, "the readings come to no result with an uncertainty", "a run that separates");
  const std::vector<uncertainty::Joint> stated = JointsOf(run, estimator, budgets);
  std::vector<uncertainty::Joint> joints;
  for (const uncertainty::Joint& joint : stated) joints.push_back(Combined(joint, budgets));
  uncertainty::MonteCarlo trials;
  if (how) {
    uncertainty::MonteCarloOptions with_joints = *how;
    with_joints.joints = stated;
    trials = uncertainty::Propagate(run.scenario, evaluate, with_joints);
  }
  const uncertainty::MonteCarlo* const drawn = how ? &trials : nullptr;
  Answer answer{report::BudgetJson(budgets, joints, drawn), ""};
  if (run.scenario.uncertainties.empty())
    answer.text = "The scenario states no u_<key> (u_wavelength_nm = 0.01): only what the readings say counts.\n\n";
  answer.text += report::WithoutNoNumbers(report::BudgetText(budgets, joints, drawn));
  return answer;
}

void AddUncertainty(CLI::App& app) {
  auto* command = app.add_subcommand(
      "uncertainty",
      "Uncertainty budget of a run's results (GUM), and by Monte Carlo (Supplement 1)");
  auto options = std::make_shared<UncertaintyOptions>();
  options->trials.threads = ProcessorCount();
  command->add_option("source", options->source, "folder of a run, or a readings.csv")->required();
  command->add_option("--scenario", options->scenario, "bench and procedure behind a readings.csv");
  AddEstimator(*command, options->estimator);
  command->add_flag("--monte-carlo", options->monte_carlo, "propagate distributions by Monte Carlo trials as well (Supplement 1)");
  command->add_option("--trials", options->trials.most_trials, "stop after so many at the latest")
      ->check(CLI::Range(1000, 100000000))
      ->capture_default_str();
  command->add_option("--seed", options->trials.seed, "of the trials")->capture_default_str();
  AddThreads(*command, options->trials.threads);
  AddSet(*command, options->overrides);
  AnswerWith(*command, "the result", [options](JsonAnswer& answer) { State(*options, answer); });
}

}  // namespace twinbench::tools
