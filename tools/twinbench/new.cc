#include <fmt/core.h>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/overwriting.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_explained.h"

namespace twinbench::tools {
namespace {

struct NewOptions {
  std::string bench, file = "-";
  bool force = false;
};

void MakeNew(const NewOptions& options) {
  if (!FindFormat(options.bench)) throw UnknownBench("new", options.bench);
  RequireFree(options.file, {}, options.force);
  const std::string text = WriteExplained(options.bench);
  if (options.file == "-") {
    fmt::print("{}", text);
    return;
  }
  WriteFileAtOnce(options.file, text);
  fmt::print("{}: every key of {} with its default; twinbench check {} says whether it fits together\n", options.file,
             options.bench, options.file);
}

}  // namespace

void AddNew(CLI::App& app) {
  auto* command = app.add_subcommand("new", "Write a scenario of a bench with every key explained");
  auto options = std::make_shared<NewOptions>();
  command->add_option("bench", options->bench, "name of the bench, as `twinbench list` has it")->required();
  command->add_option("-o,--output", options->file, "file to write, - for stdout")->capture_default_str();
  AddForce(*command, options->force);
  command->callback([options] { MakeNew(*options); });
}

}  // namespace twinbench::tools
