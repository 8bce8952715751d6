#include <fmt/core.h>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/doubts.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/evaluated.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/report/error_table.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {
namespace {

struct SeparateOptions {
  std::string source, scenario, tables, estimator = "rigorous";
  std::vector<std::string> overrides;
};

/// Every table into a folder, or the errors alone into a file of that name.
void WriteAsked(const std::string& to, const report::Evaluation& evaluation) {
  if (to.empty()) return;
  std::vector<report::ResultTable> tables = {report::ErrorTable(evaluation)};
  if (to.ends_with(".csv")) return WriteFileAtOnce(to, tables.front().text);
  tables.insert(tables.end(), evaluation.tables.begin(), evaluation.tables.end());
  WriteTables(to, tables);
}

void Separate(const SeparateOptions& options, JsonAnswer& answer) {
  RequireOutput(answer.to(), {options.source, options.scenario});
  const RecordedRun run = LoadPlausibleRun(options.source, options.scenario, options.overrides);
  const report::Evaluation evaluation =
      EvaluationOf(run.scenario, run.readings, EstimatorNamed(options.estimator));
  if (!evaluation.Separated())
    throw InputError(options.source, evaluation.not_separated, "readings of a full-circle test");
  answer.Write(evaluation.separation);
  WriteAsked(options.tables, evaluation);
  if (!answer.IsOnStdout()) fmt::print("{}", evaluation.summary);
}

}  // namespace

void AddSeparate(CLI::App& app) {
  auto* command = app.add_subcommand(
      "separate", "Separate readings into the errors of the table under test and of its reference");
  auto options = std::make_shared<SeparateOptions>();
  command->add_option("source", options->source, "folder of a run, or a readings.csv")->required();
  command->add_option("--scenario", options->scenario, "bench and procedure behind a readings.csv");
  AddOutput(*command, options->tables, "errors by position with u (errors.csv) and the bench's other tables into a folder, or the errors alone into a FILE.csv,", ",--tables");
  AddEstimator(*command, options->estimator);
  AddSet(*command, options->overrides);
  AnswerWith(*command, "separation.json", [options](JsonAnswer& answer) { Separate(*options, answer); });
}

}  // namespace twinbench::tools
