#include <fmt/core.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/overwriting.h"
#include "tools/twinbench/wrong_source.h"
#include "twin/core/csv.h"
#include "twin/core/number_text.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {
namespace {

struct ExportOptions {
  std::string folder;
  std::string readings = "-";
  bool force = false;
};

/// Numbers where all cells are or nothing stands (null), to the bits of the text; else text.
nlohmann::json ColumnJson(const CsvTable& table, std::size_t column) {
  nlohmann::json numbers = nlohmann::json::array(), texts = nlohmann::json::array();
  bool are_numbers = true;
  for (const CsvTable::Row& row : table.rows) {
    const std::string& cell = row.fields[column];
    const std::optional<double> number = ParseNumber(cell);
    are_numbers = are_numbers && (number || cell.empty());
    numbers.push_back(number ? nlohmann::json(*number) : nlohmann::json());
    texts.push_back(cell);
  }
  return are_numbers ? numbers : texts;
}

/// The readings by their columns, as in readings.csv.
nlohmann::json ColumnsJson(const std::vector<Reading>& readings, const std::string& bench) {
  std::stringstream text;
  WriteReadingsCsv(readings, bench, text);
  const CsvTable table = ParseCsv(text, "readings.csv");
  nlohmann::json columns = nlohmann::json::object();
  for (std::size_t k = 0; k < table.columns.size(); ++k) columns[table.columns[k]] = ColumnJson(table, k);
  return columns;
}

void Export(const ExportOptions& options, JsonAnswer& answer) {
  RequireFree(options.readings, {}, options.force);
  RequireRunFolder(options.folder);
  const auto record = RunRecord::Open(options.folder);
  const std::vector<Reading> readings = record->Readings();
  const std::string bench = record->provenance().bench;
  nlohmann::json json = {{"run", options.folder}, {"bench", bench}, {"readings", readings.size()}};
  if (options.readings == "-" && answer.IsOnStdout()) {  // the answer holds what the file would
    json["columns"] = ColumnsJson(readings, bench);
    return answer.Write(json);
  }
  json["file"] = options.readings;
  answer.Write(json);
  if (options.readings == "-") return WriteReadingsCsv(readings, bench, std::cout);
  WriteReadingsCsv(readings, bench, options.readings);
  fmt::print(stderr, "{} readings written to {}\n", readings.size(), options.readings);
}

}  // namespace

void AddExport(CLI::App& app) {
  auto* command = app.add_subcommand("export", "Write the readings of a run as readings.csv");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("run", options->folder, "folder of the run")->required();
  AddTextOutput(*command, options->readings, "the readings", ",--readings")->capture_default_str();
  AddForce(*command, options->force);
  AnswerWith(*command, "what was written, or without --readings the readings by their columns,", [options](JsonAnswer& answer) { Export(*options, answer); });
}

}  // namespace twinbench::tools
