#include "tools/twinbench/run_folder.h"

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "twin/core/errors.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {

namespace fs = std::filesystem;

void WriteFileAtOnce(const std::string& path, const std::string& text) {
  const std::string beside = path + ".part";
  {
    std::ofstream out(beside, std::ios::binary);
    out << text;
    out.flush();
    if (!out) throw BenchError(path + ": cannot be written");
  }
  std::error_code error;
  fs::rename(beside, path, error);
  if (error) throw BenchError(path + ": " + error.message());
}

void WriteJson(const std::string& path, const nlohmann::json& json) {
  const std::string text = json.dump(1) + "\n";
  if (path == "-") {
    fmt::print("{}", text);
  } else {
    WriteFileAtOnce(path, text);
  }
}

void WriteTables(const std::string& folder, const std::vector<report::ResultTable>& tables) {
  std::error_code error;
  if (!tables.empty()) fs::create_directories(folder, error);
  if (error) throw BenchError(folder + ": " + error.message());
  for (const report::ResultTable& table : tables)
    WriteFileAtOnce((fs::path(folder) / table.file).string(), table.text);
}

nlohmann::json ReadJson(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw InputError(path, "cannot be opened", "a file of a twinbench run");
  try {
    return nlohmann::json::parse(in);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path, error.what(), "JSON as twinbench writes it");
  }
}

RecordedRun LoadRecordedRun(const std::string& source, const std::string& scenario_path,
                            const std::vector<std::string>& overrides) {
  const bool folder = fs::is_directory(source);
  if (!folder && !fs::exists(source)) throw InputError(source, "does not exist", "a run folder or a readings file");
  if (!folder && scenario_path.empty()) {
    throw InputError(source, "a readings file does not say which bench made it", "--scenario SCENARIO.toml");
  }
  RecordedRun run;
  run.scenario = LoadScenario(scenario_path.empty() ? RunFolder{source}.scenario() : scenario_path, overrides);
  run.readings = folder ? RunRecord::Open(source)->Readings() : ReadReadingsCsv(source, run.scenario.bench);
  return run;
}

}  // namespace twinbench::tools
