#include <fmt/core.h>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"
#include "twin/core/estimator.h"
#include "twin/core/run_record.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {
namespace {

struct ImportOptions {
  std::string readings, scenario, folder;
  std::vector<std::string> overrides;
};

void Import(const ImportOptions& options) {
  const Scenario scenario = LoadScenario(options.scenario, options.overrides);
  const std::vector<Reading> readings = ReadReadingsCsv(options.readings, scenario.bench);
  // Evaluated first: a file that cannot be evaluated leaves no folder behind.
  const report::Evaluation evaluation = BenchOf(scenario).evaluate(scenario, readings, Estimator::kRigorous);
  const RunFolder folder{options.folder};
  {
    const auto record = RunRecord::Create(
        folder.path, {TWINBENCH_VERSION, "import: " + options.readings, scenario.seed, "", scenario.bench});
    for (const Reading& reading : readings) record->Append(reading, {});
    record->Finish();
  }
  WriteFileAtOnce(folder.scenario(), WriteScenario(scenario));
  WriteJson(folder.results(), evaluation.results);
  fmt::print("{}", evaluation.summary);
}

}  // namespace

void AddImport(CLI::App& app) {
  auto* command = app.add_subcommand("import", "Make a run folder from anybody's readings.csv");
  auto options = std::make_shared<ImportOptions>();
  command->add_option("readings", options->readings, "readings.csv")->required();
  command->add_option("--scenario", options->scenario, "the bench that made them")->required();
  command->add_option("-o,--output", options->folder, "folder of the new run")->required();
  command->add_option("--set", options->overrides, "override a key of the scenario: procedure.positions=12")
      ->allow_extra_args(false);
  command->callback([options] { Import(*options); });
}

}  // namespace twinbench::tools
