#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/next_scenarios.h"
#include "tools/twinbench/overwriting.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/plan_advice.h"
#include "tools/twinbench/planned_run.h"
#include "tools/twinbench/planning.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/real_bench.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/report/plan_text.h"
#include "twin/report/sound.h"
#include "twin/uncertainty/quantities.h"

namespace twinbench::tools {
namespace {

struct PlanOptions : PlanWish {
  std::string scenario, next;
  std::vector<std::string> overrides;
  bool force = false;
};

/// What is told of a scenario.
struct Planned {
  std::vector<report::PlannedRun> runs;
  std::optional<double> on_real_bench;  // the scenario's own run [min]
  report::PlannedEffects effects;
  std::vector<report::Mending> mendings;
  std::vector<plan::Advice> advice;
  std::vector<report::PlannedProgramme> programme;  // one or none
  std::map<std::string, int> left_out;              // for want of time, how often
};

/// How many set-ups there shall be; 0: nothing is shifted on this bench.
/// @throws InputError if that many cannot be.
int SetupsOf(const PlanWish& options, const Scenario& scenario) {
  const std::optional<plan::ShiftDesign> design = ShiftDesignOf(scenario);
  if (!design) {
    if (options.setups > 0)
      throw InputError("--setups", "this scenario of " + scenario.bench + " shifts nothing",
                       "several mountings or heads on a bench that has them: " +
                           BenchesWhere([](const Bench& b) { return b.shift_design != nullptr; }));
    return 0;
  }
  const int count = options.setups > 0 ? options.setups : static_cast<int>(design->shifts.size());
  if (options.setups > 0 && (count < 2 || count > design->positions))
    throw InputError("--setups", fmt::format("{} mountings", count),
                     fmt::format("from 2 to the {} positions", design->positions));
  return std::clamp(count, 2, std::max(2, design->positions));
}

/// The scenario's own run, and beside it the one at the shifts that tell most.
std::vector<report::PlannedRun> RunsOf(const Scenario& scenario, const LookedAt& own, int setups,
                                       const std::vector<LookedAt>& others, Patience& patience) {
  std::vector<report::PlannedRun> runs = {OwnRun(scenario, own.planned.outlook, patience)};
  const std::optional<plan::ShiftDesign> design = ShiftDesignOf(scenario);
  if (!design) return runs;
  runs.front().shifts = plan::Judged(design->positions, design->shifts);
  const auto best = std::ranges::find_if(others, [](const LookedAt& one) { return one.run.name == kBestShifts; });
  if (best == others.end()) return runs;
  const plan::ShiftSet shifts = plan::BestShifts(design->positions, setups);
  runs.push_back({"shifts " + report::ShiftList(shifts.shifts), shifts, best->planned.outlook});
  return runs;
}

report::PlanBudget BudgetOf(const PlanWish& options) {
  return options.readings > 0.0 ? report::PlanBudget{options.readings, true}
                                : report::PlanBudget{options.minutes, false};
}

/// As goals are written, without the unit: "separation.target.ez", "target.ez", "ez".
void AddEnds(const std::string& kind, std::vector<std::string>& ends) {
  const std::string unit = uncertainty::UnitOf(kind);
  for (std::string end = kind.substr(0, unit.empty() ? kind.size() : kind.size() - unit.size() - 1);; end = end.substr(end.find('.') + 1)) {
    ends.push_back(end);
    if (end.find('.') == std::string::npos) return;
  }
}

/// @throws InputError if no result of the run is the one that shall count, naming those there are.
void RequireGoal(const std::string& goal, const LookedAt& own) {
  if (!plan::GainsOf(own.results, own.results, goal).empty()) return;
  std::vector<std::string> kinds;
  for (const plan::Gain& gain : plan::GainsOf(own.results, own.results, "")) kinds.push_back(gain.name);
  if (goal.empty()) return;
  std::vector<std::string> ends;
  for (const std::string& kind : kinds) AddEnds(kind, ends);
  throw InputError("--goal " + goal, "the run gives no such result",
                   fmt::format("one of {}; the nearest is {}", fmt::join(kinds, ", "), Nearest(goal, ends)));
}

Planned PlanOf(const PlanWish& options, const Scenario& scenario) {
  constexpr double kOfOtherRuns = 0.15;  // of the time, before causes are weighed: most take little
  Patience patience = options.cpu_s > 0.0 ? Patience(options.cpu_s) : Patience();
  const int setups = SetupsOf(options, scenario);
  Doing("the run as the scenario says");
  LookedAt own = ResultsOfOwn(scenario);
  RequireGoal(options.goal, own);
  const std::vector<Reading> readings = ReadingsOfTwin(Quick(scenario));
  Planned planned;
  planned.on_real_bench = MinutesOnRealBench(scenario);
  std::vector<LookedAt> others = LookAtOthers(scenario, setups, kOfOtherRuns, patience);
  planned.effects = EffectsIn(scenario, readings, patience);
  own.isolability = planned.effects.seen.isolability;
  own.is_looked_at_for_causes = true;
  planned.mendings = Mendings(scenario, own, patience);
  LookAtCauses(scenario, patience, others);
  planned.runs = RunsOf(scenario, own, setups, others, patience);
  planned.advice = AdviceOf(own, others, options.goal);
  const report::PlanBudget budget = BudgetOf(options);
  if (budget.amount > 0.0) planned.programme.push_back(ProgrammeOf(own, others, budget, options.goal));
  planned.left_out = patience.left_out();
  return planned;
}

/// All runs of a programme, each as often as it has it: those that buy most per minute first.
std::vector<plan::NextRun> RunsInOrder(const report::PlannedProgramme& programme) {
  std::vector<plan::Advice> chosen;
  for (std::size_t k = 0; k < programme.runs.size(); ++k)
    chosen.insert(chosen.end(), static_cast<std::size_t>(programme.best.times[k]), programme.runs[k]);
  plan::Rank(chosen);
  std::vector<plan::NextRun> runs;
  for (const plan::Advice& advice : chosen) runs.push_back(advice.run);
  return runs;
}

/// Asked for set-ups: these. What cannot be separated is mended first; then comes the programme, or the run that
/// buys most per minute.
std::vector<plan::NextRun> NextOf(const PlanWish& options, const Planned& planned) {
  const auto named =
      std::ranges::find_if(planned.advice, [](const plan::Advice& one) { return one.run.name == kBestShifts; });
  if (options.setups > 0 && named != planned.advice.end()) return {named->run};
  if (!planned.mendings.empty()) return {planned.mendings.front().run};
  if (planned.programme.empty()) return {planned.advice.front().run};
  std::vector<plan::NextRun> runs = RunsInOrder(planned.programme.front());
  return runs.empty() ? std::vector<plan::NextRun>{planned.advice.front().run} : runs;
}

nlohmann::json JsonOf(const std::string& title, const Planned& planned, const std::vector<plan::NextRun>& next) {
  nlohmann::json json = report::PlanJson(planned.runs, planned.effects);
  json["title"] = title;
  json["mendings"] = report::MendingJson(planned.mendings);
  json["advice"] = report::PlanAdviceJson(planned.advice);
  if (!planned.programme.empty()) json["programme"] = report::ProgrammeJson(planned.programme.front());
  json["left_out"] = planned.left_out;
  if (planned.on_real_bench) json["real_bench_minutes"] = *planned.on_real_bench;
  json["next"] = next.front().name;
  for (const plan::NextRun& run : next) json["next_runs"].push_back(run.name);
  return json;
}

std::string LeftOutText(const std::map<std::string, int>& left_out) {
  std::vector<std::string> parts;
  for (const auto& [what, times] : left_out)
    parts.push_back(times == 1 ? what : fmt::format("{} ({} times)", what, times));
  if (parts.empty()) return "";
  return fmt::format("\nNot looked at within --cpu seconds of CPU time: {}. With --cpu 0 all is.\n",
                     fmt::join(parts, "; "));
}

std::string TextOf(const Planned& planned) {
  const double minutes = planned.runs.front().outlook.minutes;
  const std::string with_proofs = WithProofs(minutes, planned.on_real_bench);
  std::string text = report::PlanText(planned.runs, planned.effects, planned.programme) + "\n" +
                     report::MendingText(planned.mendings);
  if (!with_proofs.empty())
    text += fmt::format("\nAs the scenario says it takes {} minutes{}.\n", report::MinutesText(minutes), with_proofs);
  if (!planned.mendings.empty()) text += "\n";
  text += report::PlanAdviceText(planned.advice);
  if (!planned.programme.empty()) text += "\n" + report::ProgrammeText(planned.programme.front());
  return text + LeftOutText(planned.left_out);
}

void Plan(const PlanOptions& options, JsonAnswer& answer) {
  RequireFree(options.next, {options.scenario}, options.force);
  RequireOutput(answer.to(), {options.scenario});
  for (const std::string& output : {options.next, answer.to()}) RequireFolderOf(output);
  const Scenario scenario = LoadScenario(options.scenario, options.overrides);
  const Planned planned = PlanOf(options, scenario);
  const std::vector<plan::NextRun> next = NextOf(options, planned);
  RequireFreeNext(options.next, next, options.scenario, options.force);
  if (!options.next.empty()) WriteNext(options.next, next, scenario);
  answer.Write(JsonOf(scenario.title, planned, next));
  if (!answer.IsOnStdout()) fmt::print("{}", report::WithoutNoNumbers(TextOf(planned)));
}

}  // namespace

PlanMade MakePlan(const Scenario& scenario, const PlanWish& wish) {
  const Planned planned = PlanOf(wish, scenario);
  const std::vector<plan::NextRun> next = NextOf(wish, planned);
  return {JsonOf(scenario.title, planned, next), ScenariosOf(next, scenario)};
}

void AddPlan(CLI::App& app) {
  auto* command = app.add_subcommand(
      "plan", "Expected uncertainty of a run, what it cannot resolve, and which run to make next");
  auto options = std::make_shared<PlanOptions>();
  command->add_option("scenario", options->scenario, "TOML file")->required();
  command->add_option("--setups", options->setups, "how many there may be; left out: as many as the scenario has")
      ->check(CLI::Range(2, 100000));
  auto* const minutes =
      command->add_option("--minutes", options->minutes, "budget for further runs, by the procedure's clock")
          ->check(AboveZero());
  command->add_option("--readings", options->readings, "budget for further runs, in readings")
      ->check(AboveZero())
      ->excludes(minutes);
  options->cpu_s = 7.0;
  command
      ->add_option("--cpu", options->cpu_s,
                   "CPU time [s] from which on less is looked at, and what is left out is said; 0: no end")
      ->check(FromZero())
      ->capture_default_str();
  command->add_option("--goal", options->goal, "the result that counts: target.ez; left out: all");
  AddOutput(*command, options->next,
            "the scenario of the run to be made next, or all of a programme as next-1-of-3-NAME.toml,");
  AddSet(*command, options->overrides);
  AddForce(*command, options->force);
  AnswerWith(*command, "the result", [options](JsonAnswer& answer) { Plan(*options, answer); });
}

}  // namespace twinbench::tools
