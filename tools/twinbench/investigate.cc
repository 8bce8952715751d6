#include <fmt/core.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

#include "tools/twinbench/bench_means.h"
#include "tools/twinbench/cache_folder.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/investigated_bench.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/investigate/investigation.h"
#include "twin/investigate/json.h"
#include "twin/report/investigation_text.h"
#include "twin/report/sound.h"

namespace twinbench::tools {
namespace {

struct InvestigateOptions {
  std::string scenario, twin, bench, goal, folder, cache, budget = "2h";
  std::vector<std::string> overrides;
  double conclusive = 0.95;
  std::optional<double> faint;
  int most_runs = 20;
  bool ask = false;
  std::optional<int> web;  // port of the live page
};

/// "2h", "90min", "1800s".
double BudgetMinutes(const std::string& text) {
  static const std::regex pattern(R"(([0-9.]+)\s*(h|min|s))");
  std::smatch match;
  if (!std::regex_match(text, match, pattern))
    throw InputError("--budget " + text, "is no time", "a number of h, min or s: 2h, 90min");
  const double minutes = match[2] == "h" ? 60.0 : match[2] == "min" ? 1.0 : 1.0 / 60.0;
  return std::strtod(match[1].str().c_str(), nullptr) * minutes;
}

/// Shows what there is to choose from and waits for yes or no.
bool Ask(const investigate::Step& step, const std::vector<investigate::Advice>& advice) {
  fmt::print("\n{}\nMake {} next ({})? [y/n] ", report::AdviceText(advice), step.run.name, step.reason);
  std::fflush(stdout);
  std::string answer;
  return std::getline(std::cin, answer) && (answer == "y" || answer == "yes");
}

/// What is known so far outlives the program: a file at every step.
void Keep(const InvestigateOptions& options, const Scenario& scenario, const investigate::Investigation& so_far) {
  WriteFileAtOnce(options.folder + "/investigation.json", JsonText(investigate::ToJson(so_far, scenario.bench)));
}

nlohmann::json BelievedJson(const investigate::Step& step) {
  nlohmann::json causes = nlohmann::json::array();
  for (const auto& [name, probability] : step.believed) causes.push_back({{"name", name}, {"probability", probability}});
  return {{"number", step.number}, {"run", step.run.name}, {"minutes", step.minutes}, {"causes", causes}, {"unlisted", step.unlisted}};
}

std::unique_ptr<InvestigatedBench> Open(const InvestigateOptions& options, const Scenario& scenario, LivePage& page) {
  if (options.twin.empty() == options.bench.empty())
    throw InputError("investigate", options.twin.empty() ? "there is no bench" : "there are two benches",
                     "--twin HIDDEN.toml or --bench BENCH.toml");
  if (options.folder.empty()) throw InputError("investigate", "there is no -o", "-o DIR, a folder for its runs");
  std::filesystem::create_directories(options.folder);
  if (!options.twin.empty()) return OpenHiddenTwin(options.twin, scenario, options.folder, page);
  return OpenMeasuredBench(options.bench, options.folder, page);
}

/// Between two runs nothing moves; what was found so far is kept.
void HearPage() {
  if (StopWasAsked()) throw BenchError("stopped by the operator between two runs; go on with the same command");
}

void Investigate(const InvestigateOptions& options, LivePage& page, JsonAnswer& answer) {
  const Scenario scenario = LoadScenario(options.scenario, options.overrides);
  investigate::InvestigationOptions how;
  if (!options.goal.empty()) how.goal = investigate::ParseGoal(options.goal);
  how.budget_min = BudgetMinutes(options.budget);
  how.conclusive = options.conclusive;
  how.most_runs = options.most_runs;
  how.faint = options.faint;
  const std::unique_ptr<InvestigatedBench> bench = Open(options, scenario, page);
  const auto alone = [&](const plan::NextRun& run) { return options.ask || bench->CanMakeAlone(run); };
  diagnose::DiagnoseOptions diagnosed;
  diagnosed.cache_folder = CacheFolder(options.cache);
  const investigate::Means means = MeansOf(BenchOf(scenario), alone, diagnosed);
  investigate::Laboratory laboratory;
  laboratory.measure = [&](const investigate::Step& step, const Scenario& asked) {
    HearPage();
    page.Told("step", {{"number", step.number}, {"run", step.run.name}, {"reason", step.reason}});
    return bench->Measure(step, asked);
  };
  if (options.ask) laboratory.confirm = Ask;
  laboratory.told = [&](const investigate::Investigation& so_far) {
    Keep(options, scenario, so_far);
    page.Told("believed", BelievedJson(so_far.steps.back()));
    fmt::print("{}", report::WithoutNoNumbers(report::StepText(so_far.steps.back(), so_far.goal)));
    std::fflush(stdout);
  };
  const investigate::Investigation found = investigate::Investigate(scenario, how, means, laboratory);
  Keep(options, scenario, found);
  WriteFileAtOnce(options.folder + "/extended.toml", WriteScenario(investigate::Extended(scenario, found)));
  answer.Write(investigate::ToJson(found, scenario.bench));
  if (!answer.IsOnStdout()) fmt::print("{}", report::WithoutNoNumbers(report::InvestigationText(found, scenario.bench)));
}

}  // namespace

void AddInvestigate(CLI::App& app) {
  auto* command = app.add_subcommand(
      "investigate", "Measure, diagnose and choose the most informative next run, until the cause is identified");
  auto options = std::make_shared<InvestigateOptions>();
  command->add_option("scenario", options->scenario, "what is believed of the bench (TOML)")->required();
  command->add_option("--twin", options->twin, "scenario of a twin that has something hidden");
  command->add_option("--bench", options->bench, "bench file (TOML): devices, the own twin, a program");
  command->add_option("--goal", options->goal, "how certain a result shall be: \"target.ez 0.1arcsec\"");
  command->add_option("--budget", options->budget, "of measuring: 2h, 90min")->capture_default_str();
  command->add_option("--conclusive", options->conclusive, "probability from which a cause counts as identified")
      ->check(CLI::Range(0.5, 0.9999))
      ->capture_default_str();
  command->add_option("--runs", options->most_runs, "no more than so many")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--faint", options->faint,
                      "smallest effect to detect: where nothing is found, measure on until a cause of so many noise standard deviations in "
                      "one run would be found; 0: stop after the first run. 2 unless there is a goal")
      ->check(CLI::Range(0.0, 100.0));
  AddOutput(*command, options->folder, "the folder of the investigation, which goes on if it was begun,");
  AddCache(*command, options->cache);
  AddSet(*command, options->overrides);
  command->add_flag("--ask", options->ask,
                    "confirm every run; also offers those for which somebody has to change the bench or its temperature");
  AddWebOption(*command, options->web);
  AnswerWith(*command, "investigation.json", [options](JsonAnswer& answer) {
    WithLivePage(options->web, "investigate", [&](LivePage& page) { Investigate(*options, page, answer); });
  });
}

}  // namespace twinbench::tools
