#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"

namespace twinbench::tools {
namespace {

struct CheckOptions {
  std::string scenario;
  std::vector<std::string> overrides;
};

/// Loading is the check: whatever is wrong is told with its line. The twin is built as well, for a scenario may name
/// parts that do not go together.
void Check(const CheckOptions& options, JsonAnswer& answer) {
  RequireOutput(answer.to(), {options.scenario});
  const Scenario scenario = LoadScenario(options.scenario, options.overrides);
  const Bench& bench = BenchOf(scenario);
  static_cast<void>(bench.make_twin(scenario));
  const int readings = bench.planned_readings(scenario);
  answer.Write({{"scenario", options.scenario},
                {"bench", scenario.bench},
                {"title", scenario.title},
                {"readings", readings},
                {"effects", scenario.effects.size()},
                {"stated_uncertainties", scenario.uncertainties.size()}});
  if (answer.IsOnStdout()) return;
  fmt::print("{}: fine. Bench {}, {} readings, {} effect{}, {} constant{} with a stated uncertainty\n", options.scenario,
             scenario.bench, readings, scenario.effects.size(), scenario.effects.size() == 1 ? "" : "s",
             scenario.uncertainties.size(), scenario.uncertainties.size() == 1 ? "" : "s");
}

}  // namespace

void AddCheck(CLI::App& app) {
  auto* command = app.add_subcommand("check", "Say whether a scenario can be carried out, without doing it");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  command->add_option("--set", options->overrides, "override a key of the scenario: procedure.positions=12")
      ->allow_extra_args(false);
  AnswerWith(*command, "what was found", [options](JsonAnswer& answer) { Check(*options, answer); });
}

}  // namespace twinbench::tools
