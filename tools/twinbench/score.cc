#include <fmt/core.h>

#include "tools/twinbench/analysis.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/tables.h"
#include "twin/core/errors.h"

namespace twinbench::tools {
namespace {

struct Options {
  std::string folder, json, estimator = "rigorous";
  bool positions = false;
};

TableErrors ErrorsOf(const nlohmann::json& truth, const std::string& table) {
  TableErrors errors;
  for (const double angle_deg : truth.at(table).at("position_deg"))
    errors.position_rad.push_back(angle_deg * units::deg);
  for (int c = 0; c < kComponents; ++c) {
    const bool angle = IsAngle(static_cast<Component>(c));
    const std::string column = std::string(kComponentNames[c]) + (angle ? "_arcsec" : "_um");
    for (const double v : truth.at(table).at(column))
      errors.value[c].push_back(v * (angle ? units::arcsec : units::um));
  }
  return errors;
}

void PrintScore(const Options& options) {
  const RunFolder folder{options.folder};
  const nlohmann::json truth = ReadJson(folder.truth());
  const RecordedRun run = LoadRecordedRun(folder.path, "", {});
  RequireTables(run.scenario);
  const Analysis analysis = Analyse(run.scenario, run.readings, EstimatorOf(options.estimator));
  if (!analysis.separation) throw InputError(folder.path, analysis.not_separated, "a run with a full-circle test");
  const Score score =
      CompareWithTruth(*analysis.separation, ErrorsOf(truth, "target"), ErrorsOf(truth, "reference"));
  if (!options.json.empty()) WriteJson(options.json, ToJson(score));
  if (options.json == "-") return;
  if (options.positions) fmt::print("{}\n", PositionTable(score, *analysis.separation));
  fmt::print("{} estimator against the truth; what cannot be separated is taken out of both\n{}", options.estimator,
             ScoreTable(score));
  for (const auto& lost : analysis.separation->not_separable) fmt::print("not separable: {}\n", lost.what);
}

}  // namespace

void AddScore(CLI::App& app) {
  auto* command = app.add_subcommand("score", "Compare a run of the twin with its truth");
  auto options = std::make_shared<Options>();
  command->add_option("run", options->folder, "folder of the run")->required();
  command->add_option("--estimator", options->estimator, "published or rigorous")
      ->check(CLI::IsMember({"published", "rigorous"}))
      ->capture_default_str();
  command->add_option("--json", options->json, "write the score here, - for stdout");
  command->add_flag("--positions", options->positions, "also list every position");
  command->callback([options] { PrintScore(*options); });
}

}  // namespace twinbench::tools
