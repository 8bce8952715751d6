#include "tools/twinbench/run_folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "tools/twinbench/wrong_source.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/run_record.h"
#include "twin/report/page/modest_json.h"

namespace twinbench::tools {

namespace fs = std::filesystem;

namespace {

bool IsDatabase(const std::string& path) {
  constexpr std::string_view kBegin = "SQLite format 3";
  std::string begin(kBegin.size(), '\0');
  std::ifstream in(path, std::ios::binary);
  return in.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kBegin;
}

}  // namespace

void RequireRoomFor(const RunFolder& folder, const Scenario& scenario) {
  if (fs::exists(folder.record())) return;  // the record says so itself
  if (BytesOfFile(folder.scenario()) == WriteScenario(scenario)) return;
  for (const std::string& file : {folder.scenario(), folder.truth(), folder.results()}) {
    if (fs::exists(file))
      throw InputError(file, "the file is there already, and the run would overwrite it", "a folder without it");
  }
}

void RequireOutput(const std::string& output, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  if (output.empty() || output == "-" || !fs::exists(output, ignored)) return;
  if (fs::is_directory(output)) throw InputError(output, "this is a folder", "the name of a file to write");
  for (const std::string& input : inputs) {
    if (!input.empty() && fs::equivalent(output, input, ignored))
      throw InputError(output, "the command reads this file and would overwrite it", "another name");
  }
  if (fs::is_regular_file(output) && IsDatabase(output))
    throw InputError(output, "this is a record or another database and would be overwritten", "another name");
}

void RequireFolderOf(const std::string& output) {
  std::error_code ignored;
  const fs::path folder = fs::path(output).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored)) throw BenchError(output + ": cannot be written, there is no folder " + folder.string());
}

std::string JsonText(const nlohmann::json& json) {
  return json.dump(1) + "\n";
}

void WriteTables(const std::string& folder, const std::vector<report::ResultTable>& tables) {
  std::error_code error;
  if (!tables.empty()) fs::create_directories(folder, error);
  if (error) throw BenchError(folder + ": " + error.message());
  for (const report::ResultTable& table : tables)
    WriteFileAtOnce((fs::path(folder) / table.file).string(), table.text);
}

nlohmann::json ReadJson(const std::string& path) {
  return report::ParseModestJson(InputText(path, "a file of a twinbench run"), path);
}

namespace {

/// @throws InputError if another bench made the record.
std::vector<Reading> ReadingsOf(const std::string& folder, const std::string& scenario_path, const Scenario& scenario) {
  const auto record = RunRecord::Open(folder);
  const std::string bench = record->provenance().bench;
  if (!bench.empty() && bench != scenario.bench) {
    throw InputError(scenario_path.empty() ? folder : scenario_path, "a scenario of bench " + scenario.bench,
                     fmt::format("one of {}, which made the readings in {}", bench, folder));
  }
  return record->Readings();
}

}  // namespace

RecordedRun LoadRecordedRun(const std::string& source, const std::string& scenario_path,
                            const std::vector<std::string>& overrides) {
  const bool folder = fs::is_directory(source);
  if (folder || !fs::exists(source)) RequireRunFolder(source);
  if (!folder && scenario_path.empty()) {
    const InputFault no_run = NoRun(source).fault();
    throw InputError(source, no_run.what, no_run.expected + ", or --scenario SCENARIO.toml beside a readings.csv of twinbench");
  }
  RecordedRun run;
  run.scenario = LoadScenario(scenario_path.empty() ? RunFolder{source}.scenario() : scenario_path, overrides);
  run.readings = folder ? ReadingsOf(source, scenario_path, run.scenario) : ReadReadingsCsv(source, run.scenario.bench);
  return run;
}

void WriteRun(const RunFolder& folder, const std::string& readings_from, const RecordedRun& run,
              const nlohmann::json& results, const nlohmann::json& truth) {
  RequireRoomFor(folder, run.scenario);
  const auto record =
      RunRecord::Create(folder.path, {TWINBENCH_VERSION, readings_from, run.scenario.seed, "", run.scenario.bench});
  record->WriteBeside(kScenarioFile, WriteScenario(run.scenario));
  if (!truth.is_null()) record->WriteBeside(kTruthFile, JsonText(truth));
  record->AppendAll(run.readings);
  record->Finish();
  record->WriteBeside(kResultsFile, JsonText(results));
}

}  // namespace twinbench::tools
