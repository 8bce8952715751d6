#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <functional>

#include "tests/hidden/challenge.h"
#include "tests/hidden/clean_cases.h"
#include "tests/hidden/run_cases.h"
#include "tests/hidden/score_table.h"
#include "tests/hidden/twin_cases.h"
#include "tests/hidden/unlisted.h"
#include "twin/benches/names.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_schema.h"

// Hides causes, has them found, and prints how well that went.
namespace twinbench::hidden {
namespace {

struct Options {
  std::vector<std::string> sets;
  std::string bench;  // empty: all
  std::string only;   // part of the names of the cases; empty: all
  std::string out, cases;
  int threads = 2;
  std::vector<std::string> excluded;
  TwinOptions twin;
};

std::vector<Plan> OfBenches(const Options& options,
                            const std::function<std::vector<Plan>(const std::string& bench)>& make) {
  std::vector<Plan> plans;
  for (const std::string& bench : BenchNames()) {
    if (!options.bench.empty() && options.bench != bench) continue;
    const std::vector<Plan> more = make(bench);
    plans.insert(plans.end(), more.begin(), more.end());
  }
  return plans;
}

int CountOf(const std::string& value, int otherwise) {
  return value.empty() ? otherwise : std::stoi(value);
}

std::vector<Plan> PlansOf(const std::string& set, const Options& options) {
  const std::size_t equals = set.find('=');
  const std::string name = set.substr(0, equals), value = equals == std::string::npos ? "" : set.substr(equals + 1);
  for (const std::string& bench : BenchNames()) {
    if (name == ChallengeSetOf(bench)) return ChallengePlans(value, bench, options.excluded);
  }
  if (name == "twin")
    return OfBenches(options, [&](const auto& bench) { return SinglePlans(bench, options.twin); });
  if (name == "pairs") return PairPlans(CountOf(value, 60), options.twin);
  if (name == "unlisted")
    return OfBenches(options, [&](const auto& bench) { return UnlistedPlans(bench, options.twin); });
  if (name == "leave-one-out")
    return OfBenches(options, [&](const auto& bench) { return LeaveOneOutPlans(bench, options.twin); });
  if (name == "clean") {
    return OfBenches(options, [&](const std::string& bench) {
      return CleanPlans(bench, CountOf(value, 400) / (bench == kRotaryBench ? 1 : 4), options.twin.first_seed);
    });
  }
  throw InputError("--set " + set, "there is no such set",
                   "challenge=DIR, challenge_encoder=DIR (_circular, _freeform), twin, pairs=N, unlisted, clean=N "
                   "or leave-one-out");
}

/// What made this score; where it was written to is no part of it.
std::string CommandOf(const Options& options) {
  std::string command = "hidden_score";
  for (const std::string& set : options.sets) command += " --set " + set;
  for (const std::string& effect : options.excluded) command += " --strike " + effect;
  if (!options.only.empty()) command += " --only " + options.only;
  if (!options.bench.empty()) command += " --bench " + options.bench;
  return command + fmt::format(" --magnitudes {} --seeds {} --first-seed {}", options.twin.magnitudes,
                               options.twin.seeds, options.twin.first_seed);
}

/// Thresholds of this run only: those of another version of the engine would be wrong.
class TemporaryFolder {
 public:
  TemporaryFolder() { std::filesystem::create_directories(path_); }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string Path() const { return path_; }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / fmt::format("twinbench-hidden-score-{}", ::getpid());
};

void WriteTo(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

void Score(const Options& options) {
  std::vector<Plan> plans;
  for (const std::string& set : options.sets) {
    const std::vector<Plan> more = PlansOf(set, options);
    plans.insert(plans.end(), more.begin(), more.end());
  }
  std::erase_if(plans, [&](const Plan& plan) { return plan.name.find(options.only) == std::string::npos; });
  const auto show = [](int done, int planned, const Outcome& o) {
    fmt::print(stderr, "{}/{} {} {} [{}] {}: {} {:.1f} s\n", done, planned, o.set, o.name, InWords(o.hidden),
               GradeName(o.grade), o.answer.substr(0, 120), o.seconds);
  };
  const std::vector<Outcome> outcomes = RunCases(plans, {options.threads, options.twin.cache_folder, show});
  const std::string table =
      fmt::format("# Score of the diagnosis\n\nMade by `{}` from the top folder; do not edit.\n\n{}",
                  CommandOf(options), ScoreTable(outcomes));
  if (!options.cases.empty()) WriteTo(options.cases, CasesCsv(outcomes));
  if (!options.out.empty()) WriteTo(options.out, table);
  if (options.out.empty()) fmt::print("{}", table);
}

}  // namespace
}  // namespace twinbench::hidden

int main(int argc, char** argv) {
  CLI::App app("Hides causes in readings, has them diagnosed, and scores the answers");
  twinbench::hidden::Options options;
  app.add_option("--set", options.sets,
                 "challenge=DIR, challenge_encoder=DIR (_circular, _freeform), twin, pairs=N, unlisted, clean=N, "
                 "leave-one-out")
      ->required()
      ->allow_extra_args(false);
  app.add_option("--bench", options.bench, "of the sets made by the twin, only this bench")
      ->check(CLI::IsMember(twinbench::BenchNames()));
  app.add_option("--only", options.only, "only cases with this in their name");
  app.add_option("--threads", options.threads, "cases at a time")->check(CLI::Range(1, 64));
  app.add_option("--seeds", options.twin.seeds, "cases of each effect, place and size");
  app.add_option("--magnitudes", options.twin.magnitudes, "sizes of each effect, from rho 5 to 30");
  app.add_option("--first-seed", options.twin.first_seed, "other seeds, other cases");
  app.add_option("--cache", options.twin.cache_folder,
                 "folder that keeps calibrated thresholds; else they are made anew");
  app.add_option("--out", options.out, "write the score here instead of stdout");
  app.add_option("--cases", options.cases, "write one row a case here");
  app.add_option("--strike", options.excluded, "take an effect out of the catalogue")->allow_extra_args(false);
  CLI11_PARSE(app, argc, argv);
  const twinbench::hidden::TemporaryFolder cache;
  if (options.twin.cache_folder.empty()) options.twin.cache_folder = cache.Path();
  try {
    twinbench::hidden::Score(options);
  } catch (const twinbench::InputError& refusal) {
    fmt::print(stderr, "{}\n", refusal.what());
    return 1;
  }
  return 0;
}
