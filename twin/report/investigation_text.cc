#include "twin/report/investigation_text.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/core/signal_effect.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using investigate::Advice;
using investigate::Ended;
using investigate::Investigation;
using investigate::Open;
using investigate::Step;
using investigate::Told;

constexpr std::size_t kStepsWidth = 100;
constexpr double kHardlyThere = 0.005;

std::string Believed(const Step& step) {
  std::string text;
  for (const auto& [name, probability] : step.believed) {
    if (probability >= kHardlyThere)
      text += fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", name, probability);
  }
  if (step.unlisted >= kHardlyThere) text += fmt::format(", not in the catalogue {:.3f}", step.unlisted);
  return text;
}

std::string SizesOf(const EffectSettings& effect, const std::string& bench) {
  std::string text;
  for (const EffectParameter& p : EntryOf(effect, bench).parameters) {
    const auto u = effect.finding.u.find(p.name);
    const auto value = effect.parameters.find(p.name);
    if (u == effect.finding.u.end() || value == effect.parameters.end()) continue;
    text += fmt::format("{}{} {:.4g} ± {:.2g}{}{}", text.empty() ? "" : ", ", p.name, value->second / p.to_SI,
                        u->second / p.to_SI, p.unit == "1" ? "" : " ", p.unit == "1" ? "" : p.unit);
  }
  return text;
}

std::string SizesOf(const Open& open, const std::string& bench) {
  std::string text;
  for (const EffectSettings& effect : open.fit.hypothesis.causes) {
    const std::string sizes = SizesOf(effect, bench);
    if (!sizes.empty()) text += (text.empty() ? "" : "; ") + sizes;
  }
  return text;
}

std::string Runs(const Investigation& i) {
  return fmt::format("after {} run{} and {:.0f} min", i.steps.size(), i.steps.size() == 1 ? "" : "s", i.minutes);
}

std::string Verdict(const Investigation& i) {
  const Open& best = i.belief.Best();
  switch (i.told) {
    case Told::kNothing:
      return fmt::format("Consistent with the scenario: nothing found {}", Runs(i));
    case Told::kNamed:
      return fmt::format("Cause identified: {} ({:.3f}) {}", best.fit.hypothesis.Name(), best.probability, Runs(i));
    case Told::kUnknown:
      return fmt::format("Unmodelled effect: in no entry of the catalogue ({:.3f}) {}", i.belief.unlisted,
                         Runs(i));
    case Told::kTied:
      break;
  }
  if (i.ended == Ended::kNothingMore)
    return fmt::format("Not resolvable on this bench, {}: no run that it can make distinguishes these", Runs(i));
  return fmt::format("Not concluded {} ({})", Runs(i), investigate::EndedName(i.ended));
}

std::string GoalLine(const Investigation& i) {
  if (!i.goal) return "";
  return fmt::format("Goal {}: {} (u = {:.3g} {})\n", i.goal->Text(), i.IsGoalMet() ? "met" : "not met", i.u_goal,
                     i.goal->unit);
}

}  // namespace

std::string StepText(const Step& step, const std::optional<investigate::Goal>& goal) {
  std::string text =
      fmt::format("{:>2}  {} ({:.1f} min): {}\n", step.number, step.run.name, step.minutes, step.run.words);
  text += Paragraph("    why: ", step.reason, 9, kStepsWidth);
  text += Paragraph("    now: ", Believed(step), 9, kStepsWidth);
  if (goal && std::isfinite(step.u_goal))
    text += fmt::format("    u of {} is {:.3g} {}\n", goal->quantity, step.u_goal, goal->unit);
  return text;
}

std::string AdviceText(const std::vector<Advice>& advice) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < advice.size(); ++k) {
    const Advice& a = advice[k];
    rows.push_back({fmt::format("{}", k + 1), a.run.name, fmt::format("{:.1f}", a.minutes),
                    fmt::format("{:.2f}", a.of_causes_bit), fmt::format("{:.2f}", a.of_goal_bit), a.run.words});
  }
  return TextTable(
      {{"", true}, {"run"}, {"min", true}, {"causes [bit]", true}, {"goal [bit]", true}, {"what is done"}}, rows,
      kStepsWidth);
}

std::string InvestigationText(const Investigation& investigation, const std::string& bench) {
  std::string text = "\n" + Verdict(investigation) + "\n";
  std::vector<std::vector<std::string>> rows;
  for (const Open& open : investigation.belief.open) {
    if (open.probability < kHardlyThere || open.fit.hypothesis.causes.empty()) continue;
    rows.push_back({open.fit.hypothesis.Name(), fmt::format("{:.3f}", open.probability),
                    open.fit.hypothesis.IsNamed() ? SizesOf(open, bench) : ""});
  }
  text += TextTable({{"cause"}, {"probability", true}, {"size"}}, rows, kStepsWidth);
  return text + GoalLine(investigation);
}

}  // namespace twinbench::report
