#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "tests/plan/plan_claims.h"
#include "twin/diagnose/tuning.h"

// Whether what a plan claims holds on the twin: docs/plan.md is what it printed.

namespace twinbench::plan {
namespace {

struct ClaimOptions {
  std::string bench = "rotary_4dof", sizes_of;
  std::vector<std::string> overrides;
  int cases = 60, runs = 500;
  std::uint64_t first_seed = 1;
};

void ScoreTies(const ClaimOptions& options) {
  std::vector<hidden::Placement> placements = hidden::Placements(options.bench);
  std::map<hidden::Design, diagnose::Isolability> foretold;
  int pairs = 0, named_beforehand = 0, tied_cases = 0;
  for (int k = 0; k < options.cases; ++k) {
    const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(k);
    Stream stream(seed, "plan.score");
    const auto place = static_cast<std::size_t>(stream.Uniform() * static_cast<double>(placements.size()));
    const hidden::Placement& at = placements[place];
    if (!foretold.contains(at.design)) foretold[at.design] = ForetoldOf(at.design);
    const double rho = hidden::LogUniformIn(stream, diagnose::tuning::kBaarda, 20.0);
    const TieCase judged = DiagnoseHidden(at, seed, rho, hidden::ScaleOf(at.design), foretold[at.design]);
    tied_cases += judged.pairs.empty() ? 0 : 1;
    for (const BlamedPair& pair : judged.pairs) {
      ++pairs;
      named_beforehand += pair.foretold ? 1 : 0;
      fmt::print("{:>3} rho {:.1f} {} taken for {}: {}\n", k, rho, pair.present, pair.blamed,
                 pair.foretold ? "foretold" : "NOT FORETOLD");
      std::fflush(stdout);
    }
  }
  fmt::print("{}: {} cases, {} with another cause in the answer, pairs {} of which foretold {} ({:.1f} %)\n",
             options.bench, options.cases, tied_cases, pairs, named_beforehand, 100.0 * named_beforehand / pairs);
}

void ScoreSizes(const ClaimOptions& options) {
  int inside = 0, all = 0;
  for (const SizeCheck& check : CheckSizes(LoadScenario(options.sizes_of, options.overrides), options.runs)) {
    fmt::print("{:<46} {:.3f}\n", check.cause, check.ratio);
    ++all;
    inside += std::abs(check.ratio - 1.0) <= 0.2 ? 1 : 0;
  }
  fmt::print("{} of {} detectable sizes within 20 % of {} runs\n", inside, all, options.runs);
}

}  // namespace
}  // namespace twinbench::plan

int main(int argc, char** argv) {
  twinbench::plan::ClaimOptions options;
  CLI::App app("Claims of plans against runs of the twin");
  app.add_option("--ties", options.bench, "bench in which causes are hidden one at a time");
  app.add_option("--sizes", options.sizes_of, "scenario whose smallest detectable sizes are checked instead");
  app.add_option("--set", options.overrides)->allow_extra_args(false);
  app.add_option("--cases", options.cases);
  app.add_option("--runs", options.runs);
  app.add_option("--first-seed", options.first_seed);
  CLI11_PARSE(app, argc, argv);
  options.sizes_of.empty() ? twinbench::plan::ScoreTies(options) : twinbench::plan::ScoreSizes(options);
}
