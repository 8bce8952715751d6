#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

#include "tests/hidden/unlisted.h"
#include "tests/investigate/hidden_investigation.h"
#include "tests/investigate/program_investigation.h"

// How often an investigation tells the one cause that is hidden in a twin: docs/investigate.md is what it printed.

namespace twinbench::investigate {
namespace {

struct ScoreOptions {
  std::string bench = "rotary_4dof";
  int cases = 25;
  std::uint64_t first_seed = 1;
  double rho_from = 2.0, rho_to = 20.0, budget_min = 600.0;
  double unlisted = 0.2;  // share of cases with a signal that has no name
  Wish wish = {"", 2.0};
  std::string program;  // of a bench that shares nothing with the twin, instead of one
  int only = -1;     // one case alone
  std::string dump;  // folder for believed.toml and hidden.toml of each case
};

struct Counts {
  std::map<Result, int> of;
  int cases = 0, right = 0, tied = 0, tied_right = 0, sure_and_wrong = 0;
  std::vector<double> to_wish_ratios, minutes_ratios;
};

void Count(const Judged& judged, Counts& counts) {
  ++counts.of[judged.result];
  ++counts.cases;
  counts.right += judged.IsRight();
  counts.tied += judged.tied_at_first;
  counts.tied_right += judged.tied_at_first && judged.IsRight();
  if (std::isfinite(judged.minutes_ratio)) {
    counts.to_wish_ratios.push_back(judged.to_wish_ratio);
    counts.minutes_ratios.push_back(judged.minutes_ratio);
  }
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

/// Designs with the scale of each, made once.
class Cases {
 public:
  explicit Cases(const ScoreOptions& options) : options_(options), placements_(hidden::Placements(options.bench)) {
    // A convention is there or not: no size of it can be drawn, and on some designs free tables take it up.
    std::erase_if(placements_, [](const hidden::Placement& at) { return at.effect == "convention"; });
    how_.budget_min = options.budget_min;
  }

  Judged Investigated(int k) {
    const std::uint64_t seed = options_.first_seed + static_cast<std::uint64_t>(k);
    if (!options_.program.empty()) return OfProgram(seed);
    Stream stream(seed, "investigate.score");
    const hidden::Placement& at = DrawnFrom(placements_, stream);
    const double rho = hidden::LogUniformIn(stream, options_.rho_from, options_.rho_to);
    if (stream.Uniform() < options_.unlisted) {
      const std::vector<hidden::Design> designs = hidden::PlainDesigns(options_.bench);
      const hidden::Design design = DrawnFrom(designs, stream);
      const hidden::UnlistedCause& cause = DrawnFrom(hidden::UnlistedCausesOf(options_.bench), stream);
      return InvestigateUnlisted(design, cause, seed, rho, ScaleOf(design), how_);
    }
    const hidden::SignatureScale& scale = ScaleOf(at.design);
    if (!options_.dump.empty()) Dump(at, seed, rho, scale, fmt::format("{}/{:03}", options_.dump, k));
    const auto wish = options_.wish.quantity.empty() ? std::nullopt : std::optional(options_.wish);
    return InvestigateHidden(at, seed, rho, scale, how_, wish);
  }

 private:
  template <class T>
  static const T& DrawnFrom(const std::vector<T>& all, Stream& stream) {
    return all[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(all.size()))];
  }

  const hidden::SignatureScale& ScaleOf(hidden::Design design) {
    auto& scale = scales_[design];
    if (!scale) scale = std::make_unique<hidden::SignatureScale>(design, "");
    return *scale;
  }

  Judged OfProgram(std::uint64_t seed) const {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("investigate_score_{}", seed);
    const Judged judged = InvestigateProgram(std::filesystem::absolute(options_.program), seed, folder);
    std::filesystem::remove_all(folder);
    return judged;
  }

  const ScoreOptions& options_;
  std::vector<hidden::Placement> placements_;
  std::map<hidden::Design, std::unique_ptr<hidden::SignatureScale>> scales_;
  InvestigationOptions how_;
};

/// What was believed after each run.
void PrintSteps(const Investigation& investigation) {
  for (const Step& step : investigation.steps) {
    fmt::print("      {} {} ({:.0f} min):", step.number, step.run.name, step.minutes);
    for (const auto& [name, probability] : step.believed) fmt::print(" {} {:.3f},", name, probability);
    fmt::print(" unlisted {:.3f}\n", step.unlisted);
  }
}

double MedianOf(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void PrintSummary(const ScoreOptions& options, Counts counts) {
  fmt::print("{}: right {} of {}, of those tied after the first run {} of {}, wrong above 0.95: {}\n",
             options.program.empty() ? options.bench : options.program, counts.right, counts.cases, counts.tied_right,
             counts.tied, counts.sure_and_wrong);
  for (const auto& [result, count] : counts.of) fmt::print("  {} {}\n", ResultName(result), count);
  if (counts.minutes_ratios.empty()) return;
  fmt::print("  goal met in {} cases, median minutes over those of the first run repeated: {:.2f}, with the cause told {:.2f}\n",
             counts.minutes_ratios.size(), MedianOf(counts.to_wish_ratios), MedianOf(counts.minutes_ratios));
}

void Score(const ScoreOptions& options) {
  Cases cases(options);
  Counts counts;
  for (int k = 0; k < options.cases; ++k) {
    if (options.only >= 0 && k != options.only) continue;
    const Judged judged = cases.Investigated(k);
    Count(judged, counts);
    fmt::print("{:>3} {:<10} {:<40} {} runs {:.0f} min {:.1f} s {}: {}\n", k, ResultName(judged.result),
               judged.truth, judged.investigation.steps.size(), judged.investigation.minutes, judged.seconds,
               judged.tied_at_first ? "tied" : "", judged.answer);
    if (options.only >= 0) PrintSteps(judged.investigation);
    std::fflush(stdout);
  }
  PrintSummary(options, std::move(counts));
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
  app.add_option("--unlisted", options.unlisted);
  app.add_option("--goal", options.wish.quantity, "target.ez_arcsec");
  app.add_option("--times", options.wish.times, "as certain as after the first run");
  app.add_option("--program", options.program, "tests/data/program/acquire_hidden.py");
  app.add_option("--dump", options.dump);
  CLI11_PARSE(app, argc, argv);
  twinbench::investigate::Score(options);
}
