#include "tests/investigate/hidden_investigation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "tools/twinbench/bench_means.h"
#include "twin/benches/registry.h"
#include "twin/investigate/hidden_run.h"

namespace twinbench::investigate {
namespace {

bool IsTruth(const Hypothesis& hypothesis, const EffectSettings& truth) {
  return hypothesis.causes.size() == 1 && hypothesis.causes.front().name == truth.name &&
         hypothesis.causes.front().where == truth.where;
}

bool HasTruth(const Belief& belief, const EffectSettings& truth) {
  constexpr double kLeft = 0.02;
  return std::ranges::any_of(belief.open, [&truth](const Open& open) {
    return open.probability >= kLeft && IsTruth(open.fit.hypothesis, truth);
  });
}

Result ResultOf(const Investigation& found, const EffectSettings& truth) {
  switch (found.told) {
    case Told::kNothing:
      return Result::kMissed;
    case Told::kUnknown:
      return Result::kUnnamed;
    case Told::kNamed:
      return IsTruth(found.belief.Best().fit.hypothesis, truth) ? Result::kRight : Result::kWrong;
    case Told::kTied:
      break;
  }
  if (!HasTruth(found.belief, truth)) return Result::kWrongTie;
  return found.ended == Ended::kNothingMore ? Result::kRightTie : Result::kUnfinished;
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

}  // namespace

const char* ResultName(Result result) {
  switch (result) {
    case Result::kRight:
      return "right";
    case Result::kRightTie:
      return "right tie";
    case Result::kUnfinished:
      return "unfinished";
    case Result::kMissed:
      return "missed";
    case Result::kUnnamed:
      return "unnamed";
    case Result::kWrongTie:
      return "wrong tie";
    case Result::kWrong:
      return "WRONG";
  }
  return "";
}

Judged InvestigateHidden(const hidden::Placement& at, std::uint64_t seed, double rho,
                         const hidden::SignatureScale& scale, const InvestigationOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Scenario hidden = hidden::HiddenBench(at.design, seed, {{at.effect, at.where, rho}}, scale);
  const Scenario believed = hidden::Believed(at.design);
  const Means means = tools::MeansOf(BenchOf(believed), [](const plan::NextRun&) { return true; });
  Laboratory laboratory;
  laboratory.measure = [&](const Step& step, const Scenario& asked) {
    return hidden::TakeReadings(HiddenRun(hidden, believed, step.run, asked.repeat));
  };
  Judged judged;
  judged.investigation = Investigate(believed, options, means, laboratory);
  const EffectSettings& truth = hidden.effects.front();
  judged.truth = fmt::format("{} {} rho {:.1f}", truth.name, truth.where, rho);
  judged.result = ResultOf(judged.investigation, truth);
  judged.answer = AnswerOf(judged.investigation.belief);
  const auto& first = judged.investigation.steps.front().believed;
  judged.tied_at_first = first.size() > 1 && first.front().second < options.conclusive;
  judged.probability = judged.investigation.belief.Best().probability;
  judged.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return judged;
}

}  // namespace twinbench::investigate
