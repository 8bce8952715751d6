#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
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

void MakeNew(const NewOptions& options, JsonAnswer& answer) {
  RequireOutput(answer.to(), {options.file});
  if (!FindFormat(options.bench)) throw UnknownBench("new", options.bench);
  RequireFree(options.file, {}, options.force);
  const std::string text = WriteExplained(options.bench);
  if (options.file == "-") {
    if (!answer.IsOnStdout()) fmt::print("{}", text);
    return answer.Write({{"bench", options.bench}, {"scenario_toml", text}});
  }
  WriteFileAtOnce(options.file, text);
  fmt::print("{}: every key of {} with its default; twinbench check {} says whether it fits together\n", options.file,
             options.bench, options.file);
  answer.Write({{"bench", options.bench}, {"file", options.file}});
}

}  // namespace

void AddNew(CLI::App& app) {
  auto* command = app.add_subcommand("new", "Write a scenario of a bench with every key explained");
  auto options = std::make_shared<NewOptions>();
  command->add_option("bench", options->bench, "name of the bench, as `twinbench list` has it")->required();
  AddTextOutput(*command, options->file, "the scenario")->capture_default_str();
  AddForce(*command, options->force);
  AnswerWith(*command, "what was written", [options](JsonAnswer& answer) { MakeNew(*options, answer); });
}

}  // namespace twinbench::tools
