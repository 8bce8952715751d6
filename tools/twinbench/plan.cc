#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/report/plan_text.h"

namespace twinbench::tools {
namespace {

struct PlanOptions {
  std::string scenario, json, next;
  std::vector<std::string> overrides;
  int setups = 0;
};

/// The scenario with other overrides on top of those of the command line.
Scenario With(const PlanOptions& options, const std::vector<std::string>& more) {
  std::vector<std::string> overrides = options.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return LoadScenario(options.scenario, overrides);
}

report::PlannedRun Look(const std::string& words, const Scenario& scenario, const std::vector<Reading>& readings) {
  const nlohmann::json results = BenchOf(scenario).evaluate(scenario, readings, Estimator::kRigorous).results;
  const double last_s = readings.empty() ? 0.0 : ToSeconds(readings.back().time);
  return {words, {}, plan::OutlookOf(results, static_cast<int>(readings.size()), last_s)};
}

std::string SettingOf(const plan::ShiftDesign& design, const std::vector<int>& shifts) {
  std::vector<int> counted = shifts;
  for (int& shift : counted) shift *= design.unit;
  return design.key + "=[" + report::ShiftList(counted) + "]";
}

/// The same number of set-ups (or as many as asked for) at the shifts that tell most.
void AddBetterShifts(const PlanOptions& options, const plan::ShiftDesign& design,
                     std::vector<report::PlannedRun>& runs, std::string& setting) {
  runs.front().shifts = plan::Judged(design.positions, design.shifts);
  const int count = options.setups > 0 ? options.setups : static_cast<int>(design.shifts.size());
  if (count < 2 || count > design.positions)
    throw InputError("--setups", fmt::format("{} set-ups", count),
                     fmt::format("from 2 to the {} positions", design.positions));
  const plan::ShiftSet best = plan::BestShifts(design.positions, count);
  setting = SettingOf(design, best.shifts);
  const Scenario scenario = With(options, {setting});
  runs.push_back(Look("shifts " + report::ShiftList(best.shifts), scenario, ReadingsOfTwin(scenario)));
  runs.back().shifts = best;
}

void Plan(const PlanOptions& options) {
  for (const std::string& output : {options.next, options.json}) RequireOutput(output, {options.scenario});
  const Scenario scenario = With(options, {});
  const Bench& bench = BenchOf(scenario);
  const std::vector<Reading> readings = ReadingsOfTwin(scenario);
  std::vector<report::PlannedRun> runs = {Look("as the scenario says", scenario, readings)};
  std::string setting;
  if (bench.shift_design) {
    AddBetterShifts(options, bench.shift_design(scenario), runs, setting);
  } else if (options.setups > 0 || !options.next.empty()) {
    throw InputError(options.setups > 0 ? "--setups" : "--output",
                     "the bench " + scenario.bench + " shifts nothing",
                     BenchesWhere([](const Bench& b) { return b.shift_design != nullptr; }));
  }
  const diagnose::Diagnosis seen = bench.diagnose(readings, scenario, {}).diagnosis;
  if (!options.next.empty()) WriteFileAtOnce(options.next, WriteScenario(With(options, {setting})));
  if (!options.json.empty()) WriteJson(options.json, report::PlanJson(runs, seen));
  if (options.json != "-") fmt::print("{}", report::PlanText(runs, seen));
}

}  // namespace

void AddPlan(CLI::App& app) {
  auto* command = app.add_subcommand(
      "plan",
      "Say what a run would give and what it would not see, and which shifts of the tables would give more");
  auto options = std::make_shared<PlanOptions>();
  command->add_option("scenario", options->scenario, "TOML file")->required();
  command->add_option("--setups", options->setups, "how many there may be; left out: as many as the scenario has")
      ->check(CLI::Range(2, 100000));
  command->add_option("-o,--output", options->next, "write the scenario with the better shifts here");
  command->add_option("--json", options->json, "write the result here, - for stdout");
  command->add_option("--set", options->overrides, "override a key of the scenario: procedure.positions=12")
      ->allow_extra_args(false);
  command->callback([options] { Plan(*options); });
}

}  // namespace twinbench::tools
