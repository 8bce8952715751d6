#include <fmt/core.h>

#include <optional>

#include "tools/twinbench/commanded.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/evaluated_run.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/overwriting.h"
#include "tools/twinbench/twin_run.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"

namespace twinbench::tools {
namespace {

struct RunOptions {
  std::string scenario, folder;
  std::optional<std::string> seed;
  bool noise_free = false;
  bool images = false;
  bool force = false;
  std::optional<int> web;  // port of the live page
  std::string fidelity;
  std::vector<std::string> errors;         // "target=T.csv"
  std::vector<std::string> overrides;      // "procedure.positions=12"
  std::vector<std::string> compensations;  // "target=table.csv"
};

/// The errors of a file take the place of every repeatable error the scenario gives that table.
void ReplaceErrors(Scenario& scenario, const std::string& option) {
  const std::optional<TableNames>& names = FormatOf(scenario.bench).tables;
  if (!names)
    throw InputError("--errors " + option, "the bench " + scenario.bench + " has no such table", "no --errors");
  const std::size_t equals = option.find('=');
  const std::string table = option.substr(0, equals);
  if (equals == std::string::npos || (table != names->target && table != names->reference)) {
    throw InputError("--errors " + option, "names no table",
                     fmt::format("{}=FILE.csv or {}=FILE.csv", names->target, names->reference));
  }
  TableSettings& settings = names->settings(scenario, table == names->reference);
  settings.errors = ReadTableErrors(option.substr(equals + 1));
  settings.harmonics.clear();
  settings.random_rms = {};
}

std::string SeedOverride(const std::string& seed) {
  if (!ParseSeed(seed)) throw InputError("--seed " + seed, "invalid seed", "a whole number from 0 to 2^64 - 1");
  return "seed=\"" + seed + "\"";
}

Scenario ScenarioOf(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back(SeedOverride(*options.seed));
  if (!options.fidelity.empty()) overrides.push_back(fmt::format("mechanics.fidelity=\"{}\"", options.fidelity));
  if (options.noise_free) overrides.push_back("noise_free=true");
  Scenario scenario = LoadScenario(options.scenario, overrides);
  for (const std::string& errors : options.errors) ReplaceErrors(scenario, errors);
  for (const std::string& table : options.compensations) CommandCompensation(scenario, table);
  return scenario;
}

void Run(const RunOptions& options, LivePage& page, JsonAnswer& answer) {
  const Scenario scenario = ScenarioOf(options);
  const RunFolder folder{options.folder};
  RequireOutput(answer.to(), {options.scenario});
  MakeWayForRun(folder, options.scenario, options.force);
  RunOnTwin(scenario, folder, options.images, page);
  if (EvaluateRun(scenario, folder.path, answer)) fmt::print("compare with the truth: twinbench score {}\n", folder.path);
}

}  // namespace

void AddRun(CLI::App& app) {
  auto* command = app.add_subcommand("run", "Simulate a scenario, then measure and separate its readings");
  auto options = std::make_shared<RunOptions>();
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  AddOutput(*command, options->folder, "the folder of the run")->required();
  command->add_option("--seed", options->seed, "instead of the scenario's seed");
  command->add_flag("--noise-free", options->noise_free, "no random contribution and no quantisation");
  command->add_option("--fidelity", options->fidelity, "of the mechanics: kinematic, linear or bullet")
      ->check(OneOf({"kinematic", "linear", "bullet"}));
  command
      ->add_option("--errors", options->errors, "target=FILE.csv or reference=FILE.csv: that table's true errors")
      ->allow_extra_args(false);
  AddSet(*command, options->overrides);
  command
      ->add_option("--compensation", options->compensations,
                   "target=FILE.csv: corrections that table is commanded with")
      ->allow_extra_args(false);
  command->add_flag("--images", options->images, "write the irradiance on the PSDs as OpenEXR");
  AddForce(*command, options->force);
  AddWebOption(*command, options->web);
  AnswerWith(*command, "what came of the run", [options](JsonAnswer& answer) {
    WithLivePage(options->web, "run", [&](LivePage& page) { Run(*options, page, answer); });
  });
}

}  // namespace twinbench::tools
