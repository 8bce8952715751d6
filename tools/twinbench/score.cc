#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/twinbench/answers.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/doubts.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/wrong_source.h"
#include "twin/benches/evaluated.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/core/run_record.h"
#include "twin/report/error_table.h"
#include "twin/report/evaluation.h"
#include "twin/report/page/scored.h"

namespace twinbench::tools {
namespace {

struct ScoreOptions {
  std::string folder, against, estimator = "rigorous";
  bool positions = false;
};

void PrintScore(const ScoreOptions& options, JsonAnswer& answer) {
  const RunFolder folder{options.folder};
  RequireOutput(answer.to(), {folder.truth(), folder.scenario(), options.against});
  RequireRunFolder(folder.path);
  static_cast<void>(RunRecord::Open(folder.path));  // a damaged record is told first
  if (!std::filesystem::exists(folder.truth()))
    throw InputError(folder.truth(), "is not there",
                     "a simulated run: what was measured or imported has no truth");
  const nlohmann::json truth = ReadJson(folder.truth());
  const RecordedRun run = LoadPlausibleRun(folder.path, "", {});
  report::ScoredRun score = ScoreOf(run.scenario, run.readings, truth, EstimatorNamed(options.estimator));
  const bool is_of_results = options.against.empty() && EstimatorNamed(options.estimator) == Estimator::kRigorous;
  if (is_of_results && access(folder.path.c_str(), W_OK) == 0) WriteFileAtOnce(folder.score(), JsonText(ScoreJson(score)));
  if (!options.against.empty()) score = report::ScoreAgainst(score.values, options.against);
  answer.Write(ScoreJson(score));
  if (answer.IsOnStdout()) return;
  if (options.positions || answer.verbose()) fmt::print("{}\n", score.positions);
  fmt::print("{}", score.text);
}

}  // namespace

nlohmann::json ScoreJson(const report::ScoredRun& score) {
  nlohmann::json json = score.json;
  if (!score.values.empty()) json["values"] = report::ScoredValuesJson(score.values);  // pages of results take truth from here
  return json;
}

void AddScore(CLI::App& app) {
  auto* command = app.add_subcommand("score", "Compare a simulated run with its truth");
  auto options = std::make_shared<ScoreOptions>();
  command->add_option("run", options->folder, "folder of the run")->required();
  AddEstimator(*command, options->estimator);
  command->add_option("--against", options->against, "score your own result: CSV with columns result, value and u, as separate --tables writes them");
  command->add_flag("--positions", options->positions, "also list every position, as --verbose does");
  AnswerWith(*command, "the score", [options](JsonAnswer& answer) { PrintScore(*options, answer); });
}

}  // namespace twinbench::tools
