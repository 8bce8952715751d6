#include <fmt/format.h>

#include <algorithm>

#include "twin/core/happened_once.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/investigate/expected_information.h"
#include "twin/investigate/loop.h"

namespace twinbench::investigate {

Hypothesis Loop::OutliersIn(Hypothesis hypothesis) {
  std::erase_if(hypothesis.causes, [](const Supposed& cause) { return cause.name != kOutliers; });
  return hypothesis;
}

/// Instead of the best. Where readings were struck as outliers they are in no fit, and stay beside whatever is
/// left.
std::vector<Weighed> Loop::InsteadOf(const Hypothesis& best, std::vector<Weighed> others) {
  const Hypothesis outliers = OutliersIn(best);
  if (outliers.causes.empty()) return others;
  for (Weighed& other : others) other.hypothesis = Together(outliers, other.hypothesis);
  return others;
}

/// Single disturbed readings are others in every run, and no size of any cause: each run's own diagnosis says
/// which.
void Loop::StrikeOutliersOfLast() {
  if (OutliersIn(result_.belief.Best().fit.hypothesis).causes.empty()) return;
  std::string refusal;
  const auto found = DiagnosisOf(runs_.back().readings, runs_.back().scenario, refusal);
  if (found && HoldsOutliers(*found)) StrikeOutliers(found->noise, runs_.back());
}

/// All that is open came from a diagnosis.
void Loop::NoteTold() {
  for (const Open& open : result_.belief.open) told_by_diagnosis_.push_back(open.fit.hypothesis.Name());
}

void Loop::TakeAndWeigh(Step step) {
  Belief& belief = result_.belief;
  const double before = Entropy_bit(belief.Probabilities());
  std::vector<std::string> sets = step.run.sets;
  sets.push_back(fmt::format("repeat={}", scenario_.repeat + step.number - 1));
  Take(step, Altered(scenario_, sets));
  if (WasAnyDiagnosed()) {
    StrikeOutliersOfLast();
    Update(belief, runs_, means_);
    Compare();
    DoubtAName();
    AskOthers();
    DoubtAWave();
  } else {
    std::rotate(runs_.begin(), runs_.end() - 1, runs_.end());
    Begin();
    Update(belief, runs_, means_);
  }
  Note(std::move(step), before);
}

/// Notes a name. @return whether it was not there.
bool Loop::IsNew(const std::string& name, std::vector<std::string>& noted) {
  if (std::ranges::find(noted, name) != noted.end()) return false;
  noted.push_back(name);
  return true;
}

/// A name that fits of all runs brought up and no diagnosis: what else would look like it is asked for, and some of
/// it the catalogue lacks. That run says nothing against doubles of its own.
void Loop::DoubtAName() {
  Belief& belief = result_.belief;
  const Hypothesis best = belief.Best().fit.hypothesis;
  if (!best.IsNamed() || !IsNew(best.Name(), told_by_diagnosis_)) return;
  const TakenRun& run = runs_.back();
  if (const auto& alone = LastAlone(best))
    TakeIn(belief, InsteadOf(best, LeftOpen(WithLessLikely(*alone), run.scenario, run.number)), runs_, means_,
           [this](const Hypothesis& other) { return AsMany(other); });
  NamedByFits(belief);
}

/// A name that comes first has every other cause of the catalogue held against all runs, once: one that a diagnosis
/// of few runs found too unlikely to carry on may be what all of them together say.
void Loop::AskOthers() {
  Belief& belief = result_.belief;
  const Hypothesis best = belief.Best().fit.hypothesis;
  if (!best.IsNamed() || best.causes.size() > 1 || !IsNew(best.Name(), held_against_others_)) return;
  const TakenRun& run = runs_.back();
  const auto& alone = LastAlone(best);
  if (!alone) return;
  for (const Weighed& other : InsteadOf(best, EachAlone(*alone, run.scenario, run.number)))
    TakeIn(belief, {other}, runs_, means_, [this](const Hypothesis& one) { return AsMany(one); });
}

/// That a wave fits all runs alike says nothing of its form: what repeats and is no sine does so too. The last run,
/// and all like it, are asked for overtones; what other plans' runs said of them counts as well.
void Loop::DoubtAWave() {
  const Hypothesis best = result_.belief.Best().fit.hypothesis;
  const auto is_wave = [](const Supposed& cause) { return cause.parameters.contains("frequency"); };
  if (!best.IsNamed() || std::ranges::none_of(best.causes, is_wave)) return;
  if (const auto& alone = LastAlone(best)) overtones_[runs_.back().asked.sets] = alone->overtones;
  Disagreed(result_.belief, ProbabilityOfNoSine(overtones_));
}

/// Diagnosis of the last run, and all like it, beside the scenario as it stands. None where it cannot be diagnosed.
const std::optional<diagnose::DiagnosisRun>& Loop::LastAlone(const Hypothesis& best) {
  const bool is_mean = std::ranges::none_of(best.causes, HappensOnce);
  if (alone_.runs == runs_.size() && alone_.is_mean == is_mean) return alone_.found;
  std::string refusal;
  alone_ = {runs_.size(), is_mean, DiagnosisOf(WithThoseLike(runs_.back(), best), runs_.back().scenario, refusal)};
  return alone_.found;
}

/// The last run, and all like it together, beside the best hypothesis: they agree, or they bring up more.
void Loop::Compare() {
  Belief& belief = result_.belief;
  const TakenRun& run = runs_.back();
  const Hypothesis best = belief.Best().fit.hypothesis;
  const Scenario with = With(run.scenario, best, run.number);
  const std::vector<Reading> readings = WithThoseLike(run, best);
  std::string refusal;
  const std::optional<diagnose::DiagnosisRun> diagnosed = DiagnosisOf(readings, with, refusal);
  if (!diagnosed) return;
  const diagnose::DiagnosisRun& found = *diagnosed;
  const bool agrees = found.diagnosis.verdict == diagnose::Verdict::kNone;
  if (agrees && IsOfAnotherKind()) Agreed(belief, run, means_);
  if (agrees && !best.causes.empty()) return;
  std::vector<Weighed> more =
      LeftOpen(WithLessLikely(found), with, run.number);  // where nothing is found: what would come first
  std::erase_if(more, [](const Weighed& one) { return one.hypothesis.causes.empty(); });
  for (Weighed& one : more) one.hypothesis = Together(best, one.hypothesis);
  bool is_new = TakeIn(belief, more, runs_, means_, [&best](const Hypothesis&) { return best; });
  if (agrees) return;
  if (best.IsNothing()) alone_ = {runs_.size(), true, found};
  const auto& last = LastAlone(best);
  const diagnose::DiagnosisRun& alone = last ? *last : found;
  const std::vector<Weighed> others =  // instead of the best; beside nothing that was just asked
      InsteadOf(best, LeftOpen(WithLessLikely(alone), run.scenario, run.number));
  is_new =
      TakeIn(belief, others, runs_, means_, [this](const Hypothesis& other) { return AsMany(other); }) || is_new;
  // Several causes together are a coincidence that one without a name does not need.
  if (belief.Best().fit.hypothesis.causes.size() > 1) Disagreed(belief, UnlistedBy(alone));
  if (!is_new || found.diagnosis.verdict == diagnose::Verdict::kUnknown) Disagreed(belief, UnlistedBy(found));
}

/// The mean of the runs of its plan: it shows smaller causes than any of them. What happened once did so in one of
/// them, and another is behind it.
std::vector<Reading> Loop::WithThoseLike(const TakenRun& run, const Hypothesis& best) const {
  if (std::ranges::any_of(best.causes, HappensOnce)) return run.readings;
  std::vector<const std::vector<Reading>*> alike;
  for (const TakenRun& other : runs_) {
    if (other.asked.sets == run.asked.sets) alike.push_back(&other.readings);
  }
  return diagnose::MeanOfRuns(alike, FormatOf(run.scenario.bench)).value_or(run.readings);
}

bool Loop::IsOfAnotherKind() const {
  if (!runs_.back().asked.is_of_another_kind) return false;
  return std::none_of(runs_.begin(), runs_.end() - 1,
                      [this](const TakenRun& run) { return run.asked.sets == runs_.back().asked.sets; });
}

/// The most probable one that is open of so many causes, with names if it has them; else the best there is. What
/// comes up anew is weighed by its evidence against that one's: the weights of others may stand for fits that are
/// no good.
Hypothesis Loop::AsMany(const Hypothesis& hypothesis) const {
  const Hypothesis* of_as_many = nullptr;
  for (const Open& open : result_.belief.open) {
    const Hypothesis& other = open.fit.hypothesis;
    if (other.causes.size() != hypothesis.causes.size()) continue;
    if (other.IsNamed() == hypothesis.IsNamed()) return other;
    if (!of_as_many) of_as_many = &other;
  }
  return of_as_many ? *of_as_many : result_.belief.Best().fit.hypothesis;
}

}  // namespace twinbench::investigate
