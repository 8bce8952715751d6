#include "tests/investigate/hidden_investigation.h"

#include "hw_bridge/program/program_run.h"
#include "hw_bridge/program/stops.h"
#include "tests/core/input_error.h"
#include "tests/support/thresholds.h"
#include "tools/twinbench/bench_means.h"
#include "tools/twinbench/passing_run.h"
#include "twin/benches/registry.h"
#include "twin/investigate/hidden_run.h"

namespace twinbench::investigate {
namespace {

bool IsTruth(const Hypothesis& hypothesis, const Truth& truth) {
  if (truth.effect.empty()) return !hypothesis.causes.empty() && !hypothesis.IsNamed();
  return hypothesis.causes.size() == 1 && hypothesis.causes.front().name == truth.effect &&
         hypothesis.causes.front().where == truth.where && hypothesis.causes.front().happened_in == 0;
}

bool HasTruth(const Belief& belief, const Truth& truth) {
  constexpr double kLeft = 0.02;
  double left = truth.effect.empty() ? belief.unlisted : 0.0;
  for (const Open& open : belief.open) left += IsTruth(open.fit.hypothesis, truth) ? open.probability : 0.0;
  return left >= kLeft;
}

Result ResultOf(const Investigation& found, const Truth& truth) {
  switch (found.told) {
    case Told::kNothing:
      return Result::kMissed;
    case Told::kUnknown:
      return truth.effect.empty() ? Result::kRight : Result::kUnnamed;
    case Told::kNamed:
      return IsTruth(found.belief.Best().fit.hypothesis, truth) ? Result::kRight : Result::kWrong;
    case Told::kTied:
      break;
  }
  if (!HasTruth(found.belief, truth)) return Result::kWrongTie;
  return found.ended == Ended::kNothingMore ? Result::kRightTie : Result::kUnfinished;
}

/// As certain as wished: what runs do not share of the first one's uncertainty, divided.
Goal GoalOf(const Wish& wish, const Scenario& believed, const Measure& measure, const Means& means) {
  Goal goal = ParseGoal(wish.quantity + " 1");
  const std::vector<Reading> first = measure({1, {"first", "", {}, plan::kSameKind}, ""}, believed);
  Certainty certainty(goal);
  certainty.Add(means.evaluate(first, believed));
  const double own = certainty.u();
  certainty.Share(BudgetsOf(first, believed, means));
  goal.u = std::hypot(certainty.SharedU(), own / wish.times);
  return goal;
}

std::string AnswerOf(const Belief& belief) {
  std::string text;
  for (const Open& open : belief.open) {
    constexpr double kWorthSaying = 0.02;
    if (open.probability >= kWorthSaying)
      text += fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", open.fit.hypothesis.Name(), open.probability);
  }
  return text + fmt::format(" | unlisted {:.3f}", belief.unlisted);
}

constexpr const char* kUnlisted = "unlisted";

/// Sweeps are read every half second: a run of the list has some hundred readings and not thousands.
Scenario BelievedEncoder() {
  return ParseScenario(
      "bench = \"encoder_comparison\"\nseed = 3\n[device]\nnoise_deg = 0.002\n[encoder_procedure]\n"
      "stops_per_turn = 36\nturns = 2.0\npasses = [1, -1]\ninterval_s = 0.5\n",
      "believed.toml", ".");
}

/// One run: what `measure` and `investigate` do with a bench of kind "program".
std::vector<Reading> RunOf(std::uint64_t seed, const TemporaryFolder& folder, const Scenario& asked) {
  const std::string scenario = folder.Write("scenario.toml", WriteScenario(asked)), stops = folder.File("stops.csv"),
                    readings = folder.File("readings.csv");
  const std::vector<Reading> planned = tools::ReadingsOfTwin(asked);
  hw::WriteStops(planned, asked.bench, stops);
  hw::ProgramFile file;
  file.path = folder.File("bench.toml");
  file.command = {"python3", TWINBENCH_TEST_DATA "/program/acquire_hidden.py", "{scenario}", "{stops}", "{readings}", std::to_string(seed)};
  hw::RunProgram(file, {{"scenario", scenario}, {"stops", stops}, {"readings", readings}}, [] { return false; });
  return hw::ReadStopsBack(readings, planned, asked.bench).readings;
}

Truth TruthIn(const TemporaryFolder& folder) {
  Truth truth;
  std::ifstream in(folder.File("truth.txt"));
  std::getline(in, truth.effect);
  std::getline(in, truth.words);
  if (truth.effect == kUnlisted) truth.effect.clear();
  return truth;
}

}  // namespace

const char* ResultName(Result result) {
  constexpr std::array kNames = {"right", "right tie", "unfinished", "missed", "unnamed", "wrong tie", "WRONG"};
  return kNames.at(static_cast<std::size_t>(result));
}

Means MeansOf(const Scenario& believed) {
  return tools::MeansOf(BenchOf(believed), [](const plan::NextRun&) { return true; }, test::QuickOptions(100));
}

Judged InvestigateBench(const Scenario& believed, const Truth& truth, const Measure& measure,
                        InvestigationOptions options, const std::optional<Wish>& wish) {
  const Means means = MeansOf(believed);
  if (wish) options.goal = GoalOf(*wish, believed, measure, means);
  Laboratory laboratory;
  laboratory.measure = measure;
  Judged judged;
  judged.investigation = Investigate(believed, options, means, laboratory);
  judged.truth = truth.words;
  judged.result = ResultOf(judged.investigation, truth);
  judged.answer = AnswerOf(judged.investigation.belief);
  const std::vector<Step>& steps = judged.investigation.steps;
  judged.tied_at_first = steps.front().believed.size() > 1 && steps.front().believed.front().second < options.conclusive;
  judged.probability = judged.investigation.belief.Best().probability;
  return judged;
}

Judged InvestigateHidden(const hidden::Placement& at, std::uint64_t seed, double rho,
                         const hidden::SignatureScale& scale, const InvestigationOptions& options,
                         const std::optional<Wish>& wish) {
  const Scenario hidden = hidden::HiddenBench(at.design, seed, {{at.effect, at.where, rho}}, scale);
  const Scenario believed = hidden::Believed(at.design);
  const EffectSettings& truth = hidden.effects.front();
  const auto measure = [&](const Step& step, const Scenario& asked) {
    return hidden::TakeReadings(HiddenRun(hidden, believed, step.run, asked.repeat));
  };
  return InvestigateBench(believed, {truth.name, truth.where, fmt::format("{} {} rho {:.1f}", truth.name, truth.where, rho)},
                          measure, options, wish);
}

Judged InvestigateUnlisted(hidden::Design design, const hidden::UnlistedCause& cause, std::uint64_t seed, double rho,
                           const hidden::SignatureScale& scale, const InvestigationOptions& options) {
  constexpr double kUnit = 1e-6;
  const Scenario drawn = hidden::Drawn(design, seed), believed = hidden::Believed(design);
  const std::string& bench = hidden::BenchOf(design);
  const auto shown = [&](const std::vector<Reading>& clean, int run, double size) {
    Stream stream(seed, "hidden.unlisted"), of_run(seed, fmt::format("hidden.unlisted.run{}", run));
    std::vector<Reading> with = clean;
    hidden::AddTo(bench, size * cause.draw({clean, stream, of_run}).signal, with);
    return with;
  };
  const std::vector<Reading> first = hidden::TakeReadings(drawn);
  const double size = kUnit * rho / scale.Rho(shown(first, 1, kUnit), first, seed);
  const auto measure = [&](const Step& step, const Scenario& asked) {
    return shown(hidden::TakeReadings(HiddenRun(drawn, believed, step.run, asked.repeat)), step.number, size);
  };
  return InvestigateBench(believed, {"", "", fmt::format("unlisted {} rho {:.1f}", cause.name, rho)}, measure, options);
}

Judged InvestigateProgram(std::uint64_t seed) {
  const TemporaryFolder folder;
  const Scenario believed = BelievedEncoder();
  RunOf(seed, folder, believed);
  InvestigationOptions options;
  options.budget_min = 600.0;
  const auto measure = [&](const Step&, const Scenario& asked) { return RunOf(seed, folder, asked); };
  return InvestigateBench(believed, TruthIn(folder), measure, options);
}

}  // namespace twinbench::investigate
