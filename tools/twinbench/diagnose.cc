#include "twin/diagnose/diagnose.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/twinbench/cache_folder.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/doubts.h"
#include "tools/twinbench/follow.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/terminal.h"
#include "twin/benches/diagnosis_json.h"
#include "twin/benches/registry.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/reading_clock.h"
#include "twin/core/run_record.h"
#include "twin/core/side_by_side.h"
#include "twin/diagnose/disagreement.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/json.h"
#include "twin/diagnose/screen/screen.h"
#include "twin/diagnose/shown.h"
#include "twin/plausible/check.h"
#include "twin/report/json_units.h"
#include "twin/report/diagnosis_text.h"
#include "twin/report/sound.h"
#include "twin/report/verdict_line.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

struct DiagnoseOptions {
  std::string source, scenario, extended, cache, model = "rigorous";
  std::vector<std::string> overrides, excluded;
  int threads = ProcessorCount();
  bool follow = false;
  double false_alarm_rate = 0.01;
};

void CheckExcluded(const std::vector<std::string>& excluded, const std::string& bench) {
  std::vector<std::string> names;
  for (const EffectEntry& entry : EffectCatalogue(bench)) names.push_back(entry.name);
  for (const std::string& name : excluded) {
    if (!FindEffect(name, bench))
      throw InputError("--strike " + name, "there is no such effect",
                       fmt::format("a known one; the nearest is \"{}\"", Nearest(name, names)));
  }
}

std::string Provenance(const std::string& source, std::size_t readings) {
  return fmt::format("twinbench {} diagnosed {} ({} readings) on {:%Y-%m-%d}", TWINBENCH_VERSION, source, readings,
                     fmt::gmtime(std::chrono::system_clock::now()));
}

/// Puts the diagnosis into the run's results.json, beside what is there.
void MergeIntoResults(const RunFolder& folder, nlohmann::json diagnosis, const report::DiagnosisPage& page) {
  const auto record = RunRecord::Open(folder.path);
  const std::string path = folder.results();
  nlohmann::json results = fs::exists(path) ? ReadJson(path) : nlohmann::json::object();
  diagnosis["plots"] = diagnose::PlotsJson(page.found);
  for (const double share : page.shown.share) diagnosis["plots"]["share"].push_back(report::In(1.0, share));
  diagnosis["plots"]["share_unnamed"] = report::In(1.0, page.shown.share_unnamed);
  diagnosis["in_words"] = report::DiagnosisText(page, {report::Letters::kAscii, true});
  diagnosis["screen"] = diagnose::ToJson(page.residual_tests);
  results["diagnosis"] = std::move(diagnosis);
  record->WriteBeside(kResultsFile, JsonText(results));
}

/// Writes the extended scenario, and diagnoses the same readings with it as it is read back: what it leaves is said in a note.
void WriteExtended(const DiagnoseOptions& options, const RecordedRun& run, const diagnose::DiagnoseOptions& how,
                   diagnose::DiagnosisRun& found) {
  const std::string toml = diagnose::ExtendedToml(run.scenario, found, Provenance(options.source, run.readings.size()));
  WriteFileAtOnce(options.extended, toml);
  std::string left;
  try {
    Doing("a second diagnosis, with what was found");
    const Scenario extended = ParseScenario(toml, options.extended, ".");
    if (WriteScenario(extended) == WriteScenario(run.scenario)) return;
    const diagnose::Diagnosis again = diagnose::Diagnose(run.readings, extended, how).diagnosis;
    if (again.verdict != diagnose::Verdict::kNone) left = report::VerdictLine(again, options.source);
  } catch (const InputError& refusal) {
    left = refusal.what();
  }
  if (!left.empty()) found.diagnosis.notes.push_back("the written scenario does not explain these readings. A second diagnosis with it: " + left);
}

void DiagnoseRun(const DiagnoseOptions& options, JsonAnswer& answer) {
  for (const std::string& output : {answer.to(), options.extended}) {
    RequireOutput(output, {options.source, options.scenario});
    RequireFolderOf(output);
  }
  const RecordedRun run = LoadPlausibleRun(options.source, options.scenario, options.overrides);
  CheckExcluded(options.excluded, run.scenario.bench);
  diagnose::DiagnoseOptions how;
  how.model = EstimatorNamed(options.model);
  how.excluded = options.excluded;
  how.cache_folder = CacheFolder(options.cache);
  how.threads = options.threads;
  Doing(fmt::format("searching {} readings for the causes of the catalogue", run.readings.size()));
  diagnose::DiagnosisRun found = diagnose::Diagnose(run.readings, run.scenario, how);
  Doing("");
  const diagnose::Disagreement disagreement = diagnose::DisagreementOf(found);
  if (!disagreement.line.empty()) fmt::print("{}", plausible::InLines({{!disagreement.is_plausible, disagreement.line}}));
  if (!options.extended.empty()) WriteExtended(options, run, how, found);
  // Times of a list without a clock count its rows: nothing is told or drawn against them.
  if (!HasClock(run.readings)) found.run.schedule.time_s.setZero();
  const nlohmann::json json = DiagnosisJson(found, run.scenario, options.extended);
  answer.Write(json);
  const diagnose::Shown shown = diagnose::ShownBy(found);
  report::DiagnosisPage page{found, shown, options.source};
  if (fs::is_directory(options.source)) {
    page.residual_tests = diagnose::TestResiduals(found.run, found.noise);  // before any cause is added
    if (access(options.source.c_str(), W_OK) == 0)
      MergeIntoResults({options.source}, json, page);
    else
      fmt::print(stderr, "twinbench: {} is read-only: the diagnosis is not put into its results.json\n",
                 options.source);
  }
  if (!answer.IsOnStdout()) fmt::print("{}", report::WithoutNoNumbers(report::DiagnosisText(page, {LettersOfStdout(), answer.verbose()})));
  if (!disagreement.is_plausible)
    throw InputError(options.source, disagreement.line, "readings that the scenario describes");
}

void Diagnose(const DiagnoseOptions& options, JsonAnswer& answer) {
  if (!options.follow) return DiagnoseRun(options, answer);
  Follow({options.source, options.scenario, options.overrides, options.false_alarm_rate, EstimatorNamed(options.model)}, answer);
}

}  // namespace

void AddDiagnose(CLI::App& app) {
  auto* command = app.add_subcommand("diagnose", "Identify the causes by which readings differ from a scenario");
  auto options = std::make_shared<DiagnoseOptions>();
  command->add_option("source", options->source, "folder of a run, or a readings.csv")->required();
  command->add_option("--scenario", options->scenario, "bench and procedure behind a readings.csv");
  AddOutput(*command, options->extended, "the scenario extended by what was found");
  AddSet(*command, options->overrides);
  AddEstimator(*command, options->model, ",--model");
  command->add_option("--strike", options->excluded, "exclude an effect of the catalogue")
      ->allow_extra_args(false);
  AddCache(*command, options->cache);
  AddThreads(*command, options->threads);
  command->add_flag("--follow", options->follow, "watch a run while it is recorded and raise alarms");
  command->add_option("--false-alarm-rate", options->false_alarm_rate, "of --follow, per run")->capture_default_str();
  AnswerWith(*command, "diagnosis.json", [options](JsonAnswer& answer) { Diagnose(*options, answer); });
}

}  // namespace twinbench::tools
