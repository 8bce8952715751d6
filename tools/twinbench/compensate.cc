#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/answers.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
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

struct CompensateOptions : CompensationWish {
  std::string source, scenario, table, check;
  std::vector<std::string> overrides;
};

separate::IndexErrors ErrorsOf(const RecordedRun& run, const std::string& source) {
  const Bench& bench = BenchOf(run.scenario);
  if (!bench.index_errors)
    throw InputError(source, "the bench " + run.scenario.bench + " has no table that could be compensated",
                     BenchesWhere([](const Bench& b) { return b.index_errors != nullptr; }));
  return bench.index_errors(run.scenario, run.readings);
}

/// As many entries as a controller takes, where nobody said how many.
int PointsFor(const CompensationWish& wish) {
  const int most = report::ControllerFormNamed(wish.form).most_points;
  return wish.how.points == 0 && most > 0 ? most - 1 : wish.how.points;
}

void Compensate(const CompensateOptions& options, JsonAnswer& answer) {
  for (const std::string& output : {options.table, answer.to()})
    RequireOutput(output, {options.source, options.scenario, options.check});
  PointsFor(options);  // a form that is not known is said first
  const RecordedRun run = LoadPlausibleRun(options.source, options.scenario, options.overrides);
  std::optional<RecordedRun> check;
  if (!options.check.empty()) check = LoadPlausibleRun(options.check, "", {});
  const CompensationMade made =
      CompensationOf(run, options.source, options, check ? &*check : nullptr, options.check);
  if (!options.table.empty()) WriteFileAtOnce(options.table, made.table);
  answer.Write(made.json);
  if (!answer.IsOnStdout()) fmt::print("{}", made.text);
}

std::string FormsText() {
  std::string text = "form of the table:";
  for (const report::ControllerForm& form : report::ControllerForms())
    text += fmt::format(" {} ({});", form.name, form.meaning);
  text.pop_back();
  return text;
}

}  // namespace

CompensationMade CompensationOf(const RecordedRun& run, const std::string& source, const CompensationWish& wish,
                                const RecordedRun* check, const std::string& check_source) {
  separate::CompensationOptions how = wish.how;
  how.points = PointsFor(wish);
  const separate::IndexErrors errors = ErrorsOf(run, source);
  const separate::Compensation compensation = separate::Compensate(errors, how);
  std::optional<separate::CompensationCheck> checked;
  if (check) checked = separate::CheckCompensation(errors, compensation, ErrorsOf(*check, check_source));
  CompensationMade made;
  made.json = report::CompensationJson(errors, compensation, checked ? &*checked : nullptr);
  made.text = report::WithoutNoNumbers(report::CompensationText(errors, compensation));
  if (checked) made.text += report::WithoutNoNumbers(report::CompensationCheckText(*checked));
  made.table = report::ControllerTable(wish.form, compensation.table, wish.axis,
                                       report::CompensationComments(errors, compensation, source));
  return made;
}

void AddCompensate(CLI::App& app) {
  auto* command = app.add_subcommand(
      "compensate", "Compute from the index error of a table the corrections that its controller should add");
  auto options = std::make_shared<CompensateOptions>();
  command->add_option("source", options->source, "folder of a run, or a readings.csv")->required();
  command->add_option("--scenario", options->scenario, "bench and procedure behind a readings.csv");
  AddOutput(*command, options->table, "the table");
  command->add_option("--form", options->form, FormsText())->capture_default_str();
  command->add_option("--axis", options->axis, "what the controller calls the axis")->capture_default_str();
  command->add_option("--points", options->how.points, "entries per turn; 0: as the orders and the form need")
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
  AddSet(*command, options->overrides);
  AnswerWith(*command, "the result", [options](JsonAnswer& answer) { Compensate(*options, answer); });
}

}  // namespace twinbench::tools
