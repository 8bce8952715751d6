#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/core/whole_file.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {

/// Files of a run that its record has digests of (RunRecord::WriteBeside).
inline constexpr const char* kScenarioFile = "scenario.toml";
inline constexpr const char* kTruthFile = "truth.json";
inline constexpr const char* kResultsFile = "results.json";

/// The files of one run (architecture.md, "Run record").
struct RunFolder {
  std::string path;
  std::string scenario() const { return path + "/" + kScenarioFile; }
  std::string record() const { return path + "/record.sqlite"; }
  std::string truth() const { return path + "/" + kTruthFile; }
  std::string results() const { return path + "/" + kResultsFile; }
  std::string score() const { return path + "/score.json"; }
  std::string images() const { return path + "/images"; }
};

/// Before a run is made: nothing that lies in the folder may be overwritten by it, but what a run of the same scenario
/// that came to nothing has left.
/// @throws InputError if it holds another file that the run would write.
void RequireRoomFor(const RunFolder& folder, const Scenario& scenario);

/// Before a file is written that the user named.
/// @param output  Empty or "-": no file.
/// @param inputs  Files that the command reads. Empty ones are none.
/// @throws InputError if the output is one of them, a record, or a folder.
void RequireOutput(const std::string& output, const std::vector<std::string>& inputs);

/// Before long work, of a file that the user named in no folder of the command's own making.
/// @param output  Empty or "-": no file.
/// @throws BenchError if the folder that it is to lie in is not there.
void RequireFolderOf(const std::string& output);

/// JSON as a file of a run has it; what a command answers goes through JsonAnswer.
std::string JsonText(const nlohmann::json& json);

/// Each into the folder, which is made if it is not there.
void WriteTables(const std::string& folder, const std::vector<report::ResultTable>& tables);

/// @throws InputError if the file is missing or no JSON.
nlohmann::json ReadJson(const std::string& path);

/// Readings and the scenario that describes them: of a run folder, or of a CSV file with --scenario.
struct RecordedRun {
  Scenario scenario;
  std::vector<Reading> readings;
};

/// @param source         A run folder or a readings file.
/// @param scenario_path  Empty: the folder's own scenario.toml.
/// @throws InputError    if a file source comes without a scenario, or anything cannot be read.
RecordedRun LoadRecordedRun(const std::string& source, const std::string& scenario_path,
                            const std::vector<std::string>& overrides);

/// A finished run of readings that are there: scenario.toml, record and results.json.
/// @param truth  Beside it; null: nobody knows it.
/// @throws InputError if the folder holds a run.
void WriteRun(const RunFolder& folder, const std::string& readings_from, const RecordedRun& run, const nlohmann::json& results,
              const nlohmann::json& truth);

}  // namespace twinbench::tools
