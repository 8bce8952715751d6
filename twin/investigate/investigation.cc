#include "twin/investigate/investigation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "twin/core/errors.h"
#include "twin/core/happened_once.h"
#include "twin/investigate/expected_information.h"
#include "twin/investigate/loop.h"

namespace twinbench::investigate {
namespace {

constexpr double kMostlyUnlisted = 0.5;
constexpr double kMostlyOutliers = 0.5;
constexpr double kUsuallyFaint = 2.0;
constexpr double kStandsOut = 5.0;  // noise standard deviations: such a cause is mostly found among all the others
/// Of the best: a named rival that is more probable is still in question. Looking again and again until one is past
/// a limit would otherwise make the limit's share of mistakes.
constexpr double kOutOfQuestion = 0.01;

}  // namespace

Loop::Loop(const Scenario& scenario, const InvestigationOptions& options, const Means& means,
           const Laboratory& laboratory)
    : scenario_(scenario), options_(options), means_(means), laboratory_(laboratory) {
  result_.goal = options.goal;
  result_.u_goal = kNaN;
  if (options.goal) certainty_.emplace(*options.goal);
}

Investigation Loop::Run() {
  RefuseGoalsOutOfReach(scenario_, means_.twin);
  TakeFirst();
  while (!IsDone() && TakeNext()) {
  }
  result_.told = ToldBy(result_.belief, kMostlyUnlisted);
  if (result_.told == Told::kTied && result_.belief.Best().fit.hypothesis.IsNothing())
    result_.told = Told::kNothing;                     // suspicions are no findings
  if (!WasAnyDiagnosed()) result_.told = Told::kTied;  // nor is nothing where nothing could be looked for
  return std::move(result_);
}

/// @param unlisted  From which probability on it is something that the catalogue lacks.
Told Loop::ToldBy(const Belief& belief, double unlisted) const {
  const Open& best = belief.Best();
  const bool is_unnamed = !best.fit.hypothesis.causes.empty() && !best.fit.hypothesis.IsNamed();
  if (belief.unlisted + (is_unnamed ? best.probability : 0.0) >= unlisted && belief.unlisted > best.probability)
    return Told::kUnknown;
  if (best.probability < options_.conclusive || HasRival(belief)) return Told::kTied;
  if (best.fit.hypothesis.IsNamed()) return Told::kNamed;
  return best.fit.hypothesis.IsNothing() ? Told::kNothing : Told::kUnknown;
}

bool Loop::HasRival(const Belief& belief) const {
  const double limit = kOutOfQuestion * belief.Best().probability;
  return std::any_of(belief.open.begin() + 1, belief.open.end(), [limit](const Open& open) {
    return open.fit.hypothesis.IsNamed() && open.probability > limit;
  });
}

bool Loop::IsDone() {
  if (!WasAnyDiagnosed() || !AreCausesTold() || !result_.IsGoalMet() || MayBeFaint() || ShouldRepeat())
    return false;
  result_.ended = Ended::kTold;
  return true;
}

bool Loop::IsNothingFound() const {
  return result_.belief.Best().fit.hypothesis.IsNothing() && !IsMostlyUnlisted();
}

/// Nothing is found, and a cause of the size that is asked for could still hide in the noise.
bool Loop::MayBeFaint() const {
  return IsNothingFound() && WorthSoFar() < RunsToShowFaint();
}

/// What happened in the last run has happened once if another one does not show it again: a wander may look so too.
bool Loop::MayHappenAgain() const {
  const Hypothesis& best = result_.belief.Best().fit.hypothesis;
  return best.IsNamed() && std::ranges::any_of(best.causes, [this](const Supposed& cause) {
           return HappensOnce(cause) && cause.happened_in == runs_.back().number;
         });
}

/// The first run showed nothing, and the last one brought the name up: chance, or another thing that looks like
/// it there, would not do so twice.
bool Loop::IsNewsOfOneRun() const {
  const Hypothesis& best = result_.belief.Best().fit.hypothesis;
  if (!best.IsNamed() || result_.steps.size() < 2) return false;
  const auto came_first = [](const Step& step) { return step.believed.front().first; };
  return came_first(result_.steps.front()) == Hypothesis{}.Name() &&
         came_first(*(result_.steps.end() - 2)) != best.Name();
}

/// In runs of the plan that was diagnosed first; mostly the scenario's own.
double Loop::WorthSoFar() const {
  double worth = 0.0;
  for (const TakenRun& run : runs_) worth += WorthOf(run, runs_.front());
  return worth;
}

double Loop::Faint() const {
  return options_.faint.value_or(options_.goal ? 0.0 : kUsuallyFaint);
}

/// So many in the mean have the noise in which the cause stands out.
double Loop::RunsToShowFaint() const {
  return Faint() > 0.0 ? std::pow(kStandsOut / Faint(), 2) : 1.0;
}

bool Loop::IsMostlyUnlisted() const {
  return result_.belief.unlisted >= kMostlyUnlisted;
}

/// Makes the run and adds it to what is known.
void Loop::Take(Step& step, const Scenario& scenario) {
  runs_.push_back(TakenOf(step.run, scenario, laboratory_.measure(step, scenario), means_, step.number - 1));
  step.minutes = runs_.back().minutes;
  result_.minutes += step.minutes;
  if (!certainty_) return;
  try {
    certainty_->Add(means_.evaluate(runs_.back().readings, scenario));
  } catch (const InputError&) {  // a run that tells of causes only
  }
  result_.u_goal = certainty_->u();
}

void Loop::Note(Step step, double entropy_before) {
  const Belief& belief = result_.belief;
  for (const Open& open : belief.open) step.believed.emplace_back(open.fit.hypothesis.Name(), open.probability);
  step.unlisted = belief.unlisted;
  step.u_goal = result_.u_goal;
  step.gained_bit = entropy_before - Entropy_bit(belief.Probabilities());
  result_.steps.push_back(std::move(step));
  if (laboratory_.told) laboratory_.told(result_);
}

void Loop::TakeFirst() {
  Step step{1, {"first", "the scenario's own run", {}, plan::kSameKind}, "the scenario's own run comes first"};
  Take(step, scenario_);
  const auto taken = [this](const Scenario&) { return runs_.front().readings; };
  RefuseGoalsOutOfReach(scenario_, taken);
  result_.u_goal = certainty_ ? certainty_->u() : kNaN;
  Begin();
  Note(std::move(step), Entropy_bit(result_.belief.Probabilities()));
}

/// By the diagnosis of the first run in the list. One without redundancy - two set-ups of one pass - leaves nothing
/// to find causes by: "nothing" is open, and another run has to come.
void Loop::Begin() {
  not_diagnosed_.clear();
  std::optional<diagnose::DiagnosisRun> found =
      DiagnosisOf(runs_.front().readings, runs_.front().scenario, not_diagnosed_);
  if (!found) found.emplace().diagnosis.verdict = diagnose::Verdict::kNone;
  if (HoldsOutliers(*found)) StrikeOutliers(found->noise, runs_.front());
  result_.belief = Begun(*found, runs_, means_);
  overtones_[runs_.front().asked.sets] = found->overtones;
  if (found->diagnosis.verdict != diagnose::Verdict::kNone) NoteTold();
}

bool Loop::HoldsOutliers(const diagnose::DiagnosisRun& found) {
  return std::ranges::any_of(found.diagnosis.causes, [](const diagnose::Cause& cause) {
    return cause.effect == kOutliers && cause.probability > kMostlyOutliers;
  });
}

/// @param refusal  Why there is none.
std::optional<diagnose::DiagnosisRun> Loop::DiagnosisOf(const std::vector<Reading>& readings,
                                                        const Scenario& scenario, std::string& refusal) const {
  try {
    return means_.diagnose(readings, scenario, {});
  } catch (const InputError& error) {
    refusal = error.what();
    return std::nullopt;
  }
}

/// What nobody can reach is not measured for: first by a run of the twin, then by the first one.
/// @throws InputError if the results have no such quantity, or standards alone leave more than the goal.
void Loop::RefuseGoalsOutOfReach(const Scenario& scenario,
                                 const std::function<std::vector<Reading>(const Scenario&)>& readings_of) {
  if (!certainty_) return;
  const std::vector<Reading> readings = readings_of(scenario);
  const nlohmann::json results = means_.evaluate(readings, scenario);
  if (!Certainty(*options_.goal).Add(results))
    throw InputError("--goal " + options_.goal->Text(), "the first run's results have no such quantity",
                     fmt::format("one of {}", fmt::join(GoalNames(results), ", ")));
  certainty_->Share(BudgetsOf(readings, scenario, means_));
  if (certainty_->SharedU() >= options_.goal->u)
    throw InputError(
        "--goal " + options_.goal->Text(),
        fmt::format("cannot be reached by any number of runs: what they share leaves {:.3g} {}, most of it {}",
                    certainty_->SharedU(), options_.goal->unit, certainty_->LargestShared()),
        "an uncertainty above that, or a better standard");
}

bool Loop::End(Ended ended) {
  result_.ended = ended;
  return false;
}

const char* ToldName(Told told) {
  switch (told) {
    case Told::kNothing:
      return "nothing";
    case Told::kNamed:
      return "named";
    case Told::kTied:
      return "tied";
    case Told::kUnknown:
      return "unknown";
  }
  return "";
}

std::string FolderOf(const Step& step) {
  return fmt::format("{:02}-{}", step.number, step.run.name);
}

const char* EndedName(Ended ended) {
  switch (ended) {
    case Ended::kTold:
      return "told";
    case Ended::kBudget:
      return "budget spent";
    case Ended::kNothingMore:
      return "nothing more can be told";
    case Ended::kDeclined:
      return "declined";
  }
  return "";
}

Investigation Investigate(const Scenario& scenario, const InvestigationOptions& options, const Means& means,
                          const Laboratory& laboratory) {
  return Loop(scenario, options, means, laboratory).Run();
}

Scenario Extended(const Scenario& scenario, const Investigation& investigation) {
  return With(scenario, investigation.belief.Best().fit.hypothesis);
}

}  // namespace twinbench::investigate
