#include "twin/import/import.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/twinbench/answers.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/doubts.h"
#include "tools/twinbench/evaluated_run.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/plan_of.h"
#include "twin/benches/registry.h"
#include "twin/core/bench_format.h"
#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {
namespace {

struct ImportOptions : ImportWish {
  std::string folder;
  bool look = false;
};

/// The bench of a file whose first line has every column that readings.csv must have; empty if it is no such file.
std::string BenchOfReadingsCsv(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  while (std::getline(in, line) && (line.empty() || line[0] == '#')) {
  }
  std::istringstream header(line);
  CsvTable table;
  try {
    table = ParseCsv(header, path);
  } catch (const InputError&) {
    return "";  // whatever it is, it has no such header
  }
  const auto has = [&table](const ReadingColumn& column) { return table.Column(column.name).has_value(); };
  const BenchFormat* bench = FormatByColumns(has);
  const bool all = bench && std::ranges::all_of(bench->columns, [&has](const ReadingColumn& column) {
                     return !column.MustBeThere() || has(column);
                   });
  return all ? bench->name : "";
}

/// A file that is taken as it is: one that comes with its scenario, or that has every column a bench wants.
/// @return its bench; empty if it is to be understood first.
std::string TakenAsItIs(const ImportWish& options) {
  if (options.files.size() != 1 || !options.map.empty() || !options.columns.empty()) return "";
  if (!options.scenario.empty()) return BenchOfScenarioFile(options.scenario);
  return BenchOfReadingsCsv(options.files.front());
}

/// @param assumed  Of the recording, which whoever opens the scenario later has to know.
Scenario UsualScenario(const std::string& bench, const ImportWish& options, const std::vector<std::string>& set,
                       const std::vector<std::string>& assumed = {}) {
  std::string title = kImportedTitle + std::filesystem::path(options.files.front()).filename().string();
  for (const std::string& one : assumed) title += "; " + one;
  std::string quoted;
  for (const char c : title) quoted += c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ' ? '_' : c;
  return ParseScenario(fmt::format("bench = \"{}\"\ntitle = \"{}\"\n", bench, quoted), "the imported run", "", set);
}

/// A readings.csv as formats.md has it, read to the bit.
Imported TakeReadings(const ImportWish& options, const std::string& bench) {
  Imported taken;
  taken.scenario = options.scenario.empty() ? UsualScenario(bench, options, options.overrides)
                                            : LoadScenario(options.scenario, options.overrides);
  taken.readings = ReadReadingsCsv(options.files.front(), taken.scenario.bench);
  return taken;
}

imports::Map MapOf(const ImportWish& options) {
  imports::Map map = imports::LoadMap(options.map);
  if (map.bench.empty() && !options.scenario.empty()) map.bench = BenchOfScenarioFile(options.scenario);
  for (const std::string& column : options.columns) imports::SetColumn(column, map);
  if (options.axis_number > 0) map.course.axis_number = options.axis_number;
  if (options.most_readings > 0) map.average.most_readings = options.most_readings;
  return map;
}

/// The bench's usual scenario with what the recording says about the course, or the one that is given.
Scenario ScenarioOf(const ImportWish& options, const imports::Imported& imported) {
  std::vector<std::string> set = imported.set;
  set.insert(set.end(), options.overrides.begin(), options.overrides.end());
  if (!options.scenario.empty()) return LoadScenario(options.scenario, set);
  return UsualScenario(imported.bench, options, set, imported.assumed);
}

Imported TakeAnything(const ImportWish& options) {
  imports::Imported imported = imports::Import(options.files, MapOf(options));
  return {{ScenarioOf(options, imported), std::move(imported.readings)}, std::move(imported.story)};
}

void Write(const Imported& taken, const ImportOptions& options, JsonAnswer& answer) {
  fmt::print("{}", taken.story);
  const std::vector<std::string> doubts = TellDoubts(taken.readings, taken.scenario, options.files.front());
  // Evaluated first: a file that cannot be evaluated leaves no folder behind.
  const EvaluatedRun run = EvaluatedWithBudget(taken.scenario, taken.readings);
  const RunFolder folder{options.folder};
  WriteRun(folder, "import: " + options.files.front(), taken, run.evaluation.results, nullptr);
  if (!taken.story.empty()) WriteFileAtOnce(folder.path + "/import.txt", taken.story);
  fmt::print("{}", run.text);
  nlohmann::json json = RunJson(folder, taken.scenario, taken.readings, run);
  json["doubts"] = doubts;
  if (!taken.story.empty()) json["story"] = taken.story;
  answer.Write(json);
  if (run.evaluation.IsRefuted()) throw InputError(options.files.front(), run.evaluation.not_separated, "readings of such a bench, in the units and the order that were taken");
}

/// @throws InputError where nothing would be imported, behind what was seen.
void LookOnly(const ImportOptions& options, JsonAnswer& answer) {
  const imports::Seen seen = imports::Look(options.files, MapOf(options));
  fmt::print("{}", seen.text);
  if (seen.needs) throw InputError(*seen.needs);
  TellDoubts(seen.imported->readings, ScenarioOf(options, *seen.imported), options.files.front());
  answer.Write({{"look", seen.text}});
}

void Import(const ImportOptions& options, JsonAnswer& answer) {
  std::vector<std::string> inputs = options.files;
  inputs.insert(inputs.end(), {options.scenario, options.map});
  RequireOutput(answer.to(), inputs);
  if (options.look) return LookOnly(options, answer);
  if (options.folder.empty())
    throw InputError("-o", "it is not said where the run goes",
                     "-o FOLDER, or --look to see what would be imported");
  Write(ImportedFrom(options), options, answer);
}

}  // namespace

Imported ImportedFrom(const ImportWish& wish) {
  const std::string bench = TakenAsItIs(wish);
  return bench.empty() ? TakeAnything(wish) : TakeReadings(wish, bench);
}

void AddImport(CLI::App& app) {
  auto* command = app.add_subcommand("import", "Import a recording of any layout, or a readings.csv, as a run");
  auto options = std::make_shared<ImportOptions>();
  command->add_option("files", options->files, "readings.csv, or recordings of any layout")->required();
  command->add_option("--scenario", options->scenario, "the bench that made them; left out: its usual one");
  AddOutput(*command, options->folder, "the folder of the run");
  command->add_flag("--look", options->look, "say what is understood and what is needed, write nothing");
  command->add_option("--map", options->map, "ready map or TOML file that says what the files do not (help map)");
  command->add_option("--column", options->columns, "one quantity: reference_deg='Axis 1.ActPos'")
      ->allow_extra_args(false);
  command->add_option("--axis-number", options->axis_number, "of several axes in a file the one that is taken, counted from 1 (--look lists them)");
  command->add_option("--most-readings", options->most_readings, "longer recordings are averaged in blocks");
  AddSet(*command, options->overrides);
  AnswerWith(*command, "what came of the import", [options](JsonAnswer& answer) { Import(*options, answer); });
}

}  // namespace twinbench::tools
