#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "tests/hidden/unlisted_cause.h"
#include "tests/investigate/hidden_investigation.h"
#include "tests/own_scenario/own_scenario.h"
#include "tests/scores/sets.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"

// The twin against its own scenario, and investigations.
namespace twinbench::scores {
namespace {

using investigate::Judged;

void Fill(const Judged& judged, Row& row) {
  row.hidden = judged.truth;
  row.answer = fmt::format("{}: {}", ResultName(judged.result), judged.answer);
  row.marks[kRight] = judged.IsRight();
  row.marks[kSureWrong] = judged.result == investigate::Result::kWrong && judged.probability >= hidden::kSure;
}

template <class T>
const T& DrawnFrom(const std::vector<T>& all, Stream& stream) {
  return all[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(all.size()))];
}

investigate::InvestigationOptions TenHours() {
  investigate::InvestigationOptions how;
  how.budget_min = 600.0;
  return how;
}

Judged OfTwin(const std::string& bench, std::uint64_t seed) {
  constexpr double kUnlistedShare = 0.2;
  std::vector<hidden::Placement> placements = hidden::Placements(bench);
  // A convention is there or not: no size of it can be drawn, and on some designs free tables take it up.
  std::erase_if(placements, [](const hidden::Placement& at) { return at.effect == "convention"; });
  Stream stream(seed, "investigate.score");
  const hidden::Placement& at = DrawnFrom(placements, stream);
  const double rho = hidden::LogUniformIn(stream, 2.0, 20.0);
  if (stream.Uniform() >= kUnlistedShare)
    return InvestigateHidden(at, seed, rho, hidden::ScaleOf(at.design), TenHours());
  const std::vector<hidden::Design> designs = hidden::PlainDesigns(bench);
  const hidden::Design design = DrawnFrom(designs, stream);
  const hidden::UnlistedCause& cause = DrawnFrom(hidden::UnlistedCausesOf(bench), stream);
  return InvestigateUnlisted(design, cause, seed, rho, hidden::ScaleOf(design), TenHours());
}

/// An encoder that a program in Python measures, which shares nothing with the twin.
Judged OfProgram(std::uint64_t seed) {
  const auto folder =
      std::filesystem::temp_directory_path() / fmt::format("twinbench-scores-{}-{}", ::getpid(), seed);
  const Judged judged =
      investigate::InvestigateProgram(test::DataPath("program/acquire_hidden.py"), seed, folder.string());
  std::filesystem::remove_all(folder);
  return judged;
}

}  // namespace

constexpr std::size_t kTogether = 4;  // names of cases hang on it

Plans OwnScenarioSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  const auto& all = test::OwnBenches();
  const test::OwnBench& own = *std::ranges::find(all, bench, &test::OwnBench::name);
  std::vector<test::OwnRun> runs = test::KeyRuns(own, kTogether);
  for (test::OwnRun& run : test::EffectRuns(own, 1)) {
    run.what = "effect " + run.what;
    runs.push_back(run);
  }
  // The suite runs all of them with the scenario's own seed; here are others.
  for (std::size_t k = 0; k < runs.size(); k += amount.is_long ? 1 : 4) {
    test::OwnRun run = runs[k];
    run.scenario.seed += amount.first_seed;
    plans.push_back({"own_scenario", bench, run.what, [run, cache = amount.cache_folder](Row& row) {
                       row.hidden = "none";
                       row.answer = AlarmOf(run, cache);
                       row.marks[kRight] = row.answer.empty();
                     }});
  }
  return plans;
}

Plans InvestigateSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  if (bench == kFreeformBench && !amount.is_long) return plans;  // minutes each: the standard set is to end in twenty
  const int cases = amount.is_long ? 8 : 2;
  for (int k = 0; k < cases; ++k) {
    const std::uint64_t seed = amount.first_seed + static_cast<std::uint64_t>(k);
    plans.push_back(
        {"investigate", bench, fmt::format("twin {}", seed), [=](Row& row) { Fill(OfTwin(bench, seed), row); }});
    if (bench != kEncoderBench) continue;
    plans.push_back(
        {"investigate", bench, fmt::format("program {}", seed), [=](Row& row) { Fill(OfProgram(seed), row); }});
  }
  return plans;
}

}  // namespace twinbench::scores
