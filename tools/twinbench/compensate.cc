#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/doubts.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/report/compensation_text.h"
#include "twin/report/controller_tables.h"
#include "twin/report/sound.h"

namespace twinbench::tools {
namespace {

struct CompensateOptions {
  std::string source, scenario, table, check, form = "plain", axis = "C";
  std::vector<std::string> overrides;
  separate::CompensationOptions how;
};

separate::IndexErrors ErrorsOf(const std::string& source, const std::string& scenario,
                               const std::vector<std::string>& overrides) {
  const RecordedRun run = LoadPlausibleRun(source, scenario, overrides);
  const Bench& bench = BenchOf(run.scenario);
  if (!bench.index_errors)
    throw InputError(source, "the bench " + run.scenario.bench + " has no table that could be compensated",
                     BenchesWhere([](const Bench& b) { return b.index_errors != nullptr; }));
  return bench.index_errors(run.scenario, run.readings);
}

/// As many entries as a controller takes, where nobody said how many.
int PointsFor(const CompensateOptions& options) {
  const int most = report::ControllerFormNamed(options.form).most_points;
  return options.how.points == 0 && most > 0 ? most - 1 : options.how.points;
}

void Compensate(const CompensateOptions& options, JsonAnswer& answer) {
  for (const std::string& output : {options.table, answer.to()})
    RequireOutput(output, {options.source, options.scenario, options.check});
  separate::CompensationOptions how = options.how;
  how.points = PointsFor(options);
  const separate::IndexErrors errors = ErrorsOf(options.source, options.scenario, options.overrides);
  const separate::Compensation compensation = separate::Compensate(errors, how);
  std::optional<separate::CompensationCheck> check;
  if (!options.check.empty())
    check = separate::CheckCompensation(errors, compensation, ErrorsOf(options.check, "", {}));
  if (!options.table.empty())
    WriteFileAtOnce(options.table,
                    report::ControllerTable(options.form, compensation.table, options.axis,
                                            report::CompensationComments(compensation, options.source)));
  answer.Write(report::CompensationJson(errors, compensation, check ? &*check : nullptr));
  if (answer.IsOnStdout()) return;
  fmt::print("{}", report::WithoutNoNumbers(report::CompensationText(errors, compensation)));
  if (check) fmt::print("{}", report::WithoutNoNumbers(report::CompensationCheckText(*check)));
}

std::string FormsText() {
  std::string text = "form of the table:";
  for (const report::ControllerForm& form : report::ControllerForms())
    text += fmt::format(" {} ({});", form.name, form.meaning);
  text.pop_back();
  return text;
}

}  // namespace

void AddCompensate(CLI::App& app) {
  auto* command = app.add_subcommand(
      "compensate", "Turn the index error of a table into the corrections that its controller should add");
  auto options = std::make_shared<CompensateOptions>();
  command->add_option("source", options->source, "folder of a run, or a readings.csv")->required();
  command->add_option("--scenario", options->scenario, "bench and procedure behind a readings.csv");
  command->add_option("-o,--output", options->table, "write the table here");
  command->add_option("--form", options->form, FormsText())->capture_default_str();
  command->add_option("--axis", options->axis, "what the controller calls the axis")->capture_default_str();
  command->add_option("--points", options->how.points, "entries a turn; 0: as the orders and the form need")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command->add_option("--highest-order", options->how.search.highest_order, "lines above it are taken not to exist")
      ->check(CLI::Range(1, 2000))
      ->capture_default_str();
  command
      ->add_option("--certain", options->how.search.certain,
                   "least probability of an order among those that look alike")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--check", options->check, "a run with this table at work: compare it with the prediction");
  command->add_option("--set", options->overrides, "override a key of the scenario: procedure.positions=12")
      ->allow_extra_args(false);
  AnswerWith(*command, "the result", [options](JsonAnswer& answer) { Compensate(*options, answer); });
}

}  // namespace twinbench::tools
