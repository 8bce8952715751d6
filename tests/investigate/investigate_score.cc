#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

#include "tests/investigate/hidden_investigation.h"

// How often an investigation tells the one cause that is hidden in a twin: docs/investigate.md is what it printed.

namespace twinbench::investigate {
namespace {

struct ScoreOptions {
  std::string bench = "rotary_4dof";
  int cases = 25;
  std::uint64_t first_seed = 1;
  double rho_from = 3.0, rho_to = 20.0, budget_min = 600.0;
  int only = -1;     // one case alone
  std::string dump;  // folder for believed.toml and hidden.toml of each case
};

struct Counts {
  std::map<Result, int> of;
  int cases = 0, right = 0, tied = 0, tied_right = 0, sure_and_wrong = 0;
};

void Count(const Judged& judged, Counts& counts) {
  ++counts.of[judged.result];
  ++counts.cases;
  counts.right += judged.IsRight();
  counts.tied += judged.tied_at_first;
  counts.tied_right += judged.tied_at_first && judged.IsRight();
  counts.sure_and_wrong += judged.result == Result::kWrong && judged.probability > 0.95;
}

/// For a look at one case by the program itself.
void Dump(const hidden::Placement& at, std::uint64_t seed, double rho, const hidden::SignatureScale& scale,
          const std::string& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/believed.toml") << WriteScenario(hidden::Believed(at.design));
  std::ofstream(folder + "/hidden.toml")
      << WriteScenario(hidden::HiddenBench(at.design, seed, {{at.effect, at.where, rho}}, scale));
}

void Score(const ScoreOptions& options) {
  const std::vector<hidden::Placement> placements = hidden::Placements(options.bench);
  std::map<hidden::Design, std::unique_ptr<hidden::SignatureScale>> scales;
  InvestigationOptions how;
  how.budget_min = options.budget_min;
  Counts counts;
  for (int k = 0; k < options.cases; ++k) {
    if (options.only >= 0 && k != options.only) continue;
    const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(k);
    Stream stream(seed, "investigate.score");
    const auto place = static_cast<std::size_t>(stream.Uniform() * static_cast<double>(placements.size()));
    const hidden::Placement& at = placements[place];
    auto& scale = scales[at.design];
    if (!scale) scale = std::make_unique<hidden::SignatureScale>(at.design, "");
    const double rho = hidden::LogUniformIn(stream, options.rho_from, options.rho_to);
    if (!options.dump.empty()) Dump(at, seed, rho, *scale, fmt::format("{}/{:03}", options.dump, k));
    const Judged judged = InvestigateHidden(at, seed, rho, *scale, how);
    Count(judged, counts);
    fmt::print("{:>3} {:<10} {:<40} {} runs {:.0f} min {:.1f} s {}: {}\n", k, ResultName(judged.result),
               judged.truth, judged.investigation.steps.size(), judged.investigation.minutes, judged.seconds,
               judged.tied_at_first ? "tied" : "", judged.answer);
    std::fflush(stdout);
  }
  fmt::print("{}: right {} of {}, of those tied after the first run {} of {}, wrong above 0.95: {}\n",
             options.bench, counts.right, counts.cases, counts.tied_right, counts.tied, counts.sure_and_wrong);
  for (const auto& [result, count] : counts.of) fmt::print("  {} {}\n", ResultName(result), count);
}

}  // namespace
}  // namespace twinbench::investigate

int main(int argc, char** argv) {
  twinbench::investigate::ScoreOptions options;
  CLI::App app("Investigations of twins with one hidden cause");
  app.add_option("--bench", options.bench);
  app.add_option("--cases", options.cases);
  app.add_option("--first-seed", options.first_seed);
  app.add_option("--rho-from", options.rho_from);
  app.add_option("--rho-to", options.rho_to);
  app.add_option("--budget-min", options.budget_min);
  app.add_option("--only", options.only);
  app.add_option("--dump", options.dump);
  CLI11_PARSE(app, argc, argv);
  twinbench::investigate::Score(options);
}
