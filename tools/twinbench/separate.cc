#include <fmt/core.h>

#include "tools/twinbench/analysis.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/tables.h"
#include "twin/core/errors.h"

namespace twinbench::tools {
namespace {

struct Options {
  std::string source, scenario, json, estimator = "rigorous";
  std::vector<std::string> overrides;
};

/// What others script against (formats.md); results.json of a run has the rest.
nlohmann::json SeparationJson(const separate::Separation& separation) {
  const nlohmann::json all = separate::ToJson(separation);
  nlohmann::json agreed;
  for (const char* key : {"target", "reference", "not_separable", "residual_rms", "dof"}) agreed[key] = all.at(key);
  return agreed;
}

void Separate(const Options& options) {
  const RecordedRun run = LoadRecordedRun(options.source, options.scenario, options.overrides);
  RequireTables(run.scenario);
  const Analysis analysis = Analyse(run.scenario, run.readings, EstimatorOf(options.estimator));
  if (!analysis.separation)
    throw InputError(options.source, analysis.not_separated, "readings of a full-circle test");
  if (!options.json.empty()) WriteJson(options.json, SeparationJson(*analysis.separation));
  if (options.json != "-") fmt::print("{}", Summary(analysis));
}

}  // namespace

void AddSeparate(CLI::App& app) {
  auto* command = app.add_subcommand("separate", "Separate readings into the errors of both tables");
  auto options = std::make_shared<Options>();
  command->add_option("source", options->source, "folder of a run, or a readings.csv")->required();
  command->add_option("--scenario", options->scenario, "bench and procedure behind a readings.csv");
  command->add_option("--json", options->json, "write separation.json here, - for stdout");
  command->add_option("--estimator", options->estimator, "published: the paper's equations; rigorous: ours")
      ->check(CLI::IsMember({"published", "rigorous"}))
      ->capture_default_str();
  command->add_option("--set", options->overrides, "override a key of the scenario: procedure.positions=12")
      ->allow_extra_args(false);
  command->callback([options] { Separate(*options); });
}

}  // namespace twinbench::tools
