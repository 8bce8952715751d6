#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/answers.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/progress.h"
#include "twin/benches/evaluated.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/report/evaluation.h"
#include "twin/report/sound.h"
#include "twin/report/uncertainty_text.h"

namespace twinbench::tools {
namespace {

struct BudgetOptions {
  std::string scenario, figures = "stability";
  std::vector<std::string> overrides;
};

/// Numbers at or below a place of results.json, "stability.range.dy_um"; uncertainties are no figures.
void AddFigures(const nlohmann::json& node, const std::string& path, const std::string& wanted,
                std::vector<uncertainty::Figure>& figures) {
  const bool is_wanted = path == wanted || path.starts_with(wanted + ".");
  if (node.is_number_float() && is_wanted) figures.push_back({path, node.get<double>()});
  if (!node.is_object()) return;
  for (const auto& [key, value] : node.items()) {
    if (!key.starts_with("u_") && key != "diagnosis")
      AddFigures(value, path.empty() ? key : path + "." + key, wanted, figures);
  }
}

nlohmann::json ResultsOfTwin(const Scenario& scenario) {
  return EvaluationOf(scenario, ReadingsOfTwin(scenario), Estimator::kRigorous).results;
}

std::vector<uncertainty::Figure> FiguresOf(const nlohmann::json& results, const std::string& wanted) {
  std::vector<uncertainty::Figure> figures;
  AddFigures(results, "", wanted, figures);
  return figures;
}

/// Places of figures that this scenario has, before many runs are made for none.
void RequireFigures(const nlohmann::json& results, const std::string& wanted) {
  if (!FiguresOf(results, wanted).empty()) return;
  std::vector<std::string> places;
  for (const auto& [key, value] : results.items()) {
    if (!FiguresOf(results, key).empty()) places.push_back(key);
  }
  throw InputError("--of " + wanted, "the results of this scenario have no number there",
                   fmt::format("a place in results.json that has, as {}", fmt::join(places, ", ")));
}

void Share(const BudgetOptions& options, JsonAnswer& answer) {
  const Answer found =
      BudgetOf(LoadScenario(options.scenario, options.overrides), options.scenario, options.figures);
  answer.Write(found.json);
  if (!answer.IsOnStdout()) fmt::print("{}", found.text);
}

}  // namespace

Answer BudgetOf(const Scenario& scenario, const std::string& source, const std::string& figures,
                const std::function<void()>& between) {
  const Bench& bench = BenchOf(scenario);
  if (!bench.contributions)
    throw InputError(source, "there is no list of the sources that move the readings of " + scenario.bench,
                     BenchesWhere([](const Bench& b) { return b.contributions != nullptr; }));
  RequireFigures(ResultsOfTwin(scenario), figures);
  const std::vector<uncertainty::Contribution> contributions = bench.contributions(scenario);
  std::size_t runs = 0;
  const uncertainty::OneAtATime found = uncertainty::RunOneAtATime(scenario, contributions, [&](const Scenario& s) {
    if (between) between();
    Doing(fmt::format("run {} of at most {}, one source after the other off", ++runs, 2 + 2 * contributions.size()));
    return FiguresOf(ResultsOfTwin(s), figures);
  });
  return {report::ContributionsJson(found), report::WithoutNoNumbers(report::ContributionsText(found))};
}

void AddBudget(CLI::App& app) {
  auto* command = app.add_subcommand(
      "budget", "Variance contribution of each source of a simulated bench, switched off one at a time");
  auto options = std::make_shared<BudgetOptions>();
  command->add_option("scenario", options->scenario, "TOML file")->required();
  command->add_option("--of", options->figures, "the place in results.json of the figures to be shared out")
      ->capture_default_str();
  AddSet(*command, options->overrides);
  AnswerWith(*command, "the result", [options](JsonAnswer& answer) { Share(*options, answer); });
}

}  // namespace twinbench::tools
