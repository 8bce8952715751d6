#include <fmt/core.h>

#include <iostream>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/overwriting.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {
namespace {

struct ExportOptions {
  std::string folder;
  std::string readings = "-";
  bool force = false;
};

void Export(const ExportOptions& options) {
  RequireFree(options.readings, {}, options.force);
  const auto record = RunRecord::Open(options.folder);
  const std::vector<Reading> readings = record->Readings();
  const std::string bench = record->provenance().bench;
  if (options.readings == "-") return WriteReadingsCsv(readings, bench, std::cout);
  WriteReadingsCsv(readings, bench, options.readings);
  fmt::print(stderr, "{} readings written to {}\n", readings.size(), options.readings);
}

}  // namespace

void AddExport(CLI::App& app) {
  auto* command = app.add_subcommand("export", "Write the readings of a run as readings.csv");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("run", options->folder, "folder of the run")->required();
  command->add_option("--readings", options->readings, "file to write, - for stdout")->capture_default_str();
  AddForce(*command, options->force);
  command->callback([options] { Export(*options); });
}

}  // namespace twinbench::tools
