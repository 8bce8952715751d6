#include "twin/investigate/investigation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "twin/core/errors.h"
#include "twin/core/happened_once.h"
#include "twin/core/units.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/investigate/expected_information.h"

namespace twinbench::investigate {
namespace {

constexpr double kWorthMeasuring_bit = 0.05;  // of causes
constexpr double kWorthRefining_bit = 0.005;  // of the goal
constexpr double kMostlyUnlisted = 0.5;
constexpr double kMostlyOutliers = 0.5;
const char* const kOutliers = "outliers";  // in every catalogue
constexpr double kUsuallyFaint = 2.0;
constexpr double kStandsOut = 5.0;  // noise standard deviations: such a cause is mostly found among all the others
/// Of the best: a named rival that is more probable is still in question. Looking again and again until one is past
/// a limit would otherwise make the limit's share of mistakes.
constexpr double kOutOfQuestion = 0.01;

class Loop {
 public:
  Loop(const Scenario& scenario, const InvestigationOptions& options, const Means& means,
       const Laboratory& laboratory)
      : scenario_(scenario), options_(options), means_(means), laboratory_(laboratory) {
    result_.goal = options.goal;
    result_.u_goal = kNaN;
    if (options.goal) certainty_.emplace(*options.goal);
  }

  Investigation Run() {
    RefuseGoalsOutOfReach(scenario_, means_.twin);
    TakeFirst();
    while (!IsDone() && TakeNext()) {
    }
    result_.told = ToldBy(result_.belief, kMostlyUnlisted);
    if (result_.told == Told::kTied && result_.belief.Best().fit.hypothesis.IsNothing())
      result_.told = Told::kNothing;  // suspicions are no findings
    if (!WasAnyDiagnosed()) result_.told = Told::kTied;  // nor is nothing where nothing could be looked for
    return std::move(result_);
  }

 private:
  /// @param unlisted  From which probability on it is something that the catalogue lacks.
  Told ToldBy(const Belief& belief, double unlisted) const {
    const Open& best = belief.Best();
    const bool is_unnamed = !best.fit.hypothesis.causes.empty() && !best.fit.hypothesis.IsNamed();
    if (belief.unlisted + (is_unnamed ? best.probability : 0.0) >= unlisted && belief.unlisted > best.probability)
      return Told::kUnknown;
    if (best.probability < options_.conclusive || HasRival(belief)) return Told::kTied;
    if (best.fit.hypothesis.IsNamed()) return Told::kNamed;
    return best.fit.hypothesis.IsNothing() ? Told::kNothing : Told::kUnknown;
  }

  bool HasRival(const Belief& belief) const {
    const double limit = kOutOfQuestion * belief.Best().probability;
    return std::any_of(belief.open.begin() + 1, belief.open.end(), [limit](const Open& open) {
      return open.fit.hypothesis.IsNamed() && open.probability > limit;
    });
  }

  bool AreCausesTold() const { return ToldBy(result_.belief, options_.conclusive) != Told::kTied; }

  bool IsDone() {
    if (!WasAnyDiagnosed() || !AreCausesTold() || !result_.IsGoalMet() || MayBeFaint() || ShouldRepeat())
      return false;
    result_.ended = Ended::kTold;
    return true;
  }

  bool IsNothingFound() const {
    return result_.belief.Best().fit.hypothesis.IsNothing() && !IsMostlyUnlisted();
  }

  /// Nothing is found, and a cause of the size that is asked for could still hide in the noise.
  bool MayBeFaint() const {
    return IsNothingFound() && WorthSoFar() < RunsToShowFaint();
  }

  /// What happened in the last run has happened once if another one does not show it again: a wander may look so too.
  bool MayHappenAgain() const {
    const Hypothesis& best = result_.belief.Best().fit.hypothesis;
    return best.IsNamed() && std::ranges::any_of(best.causes, [this](const Supposed& cause) {
      return HappensOnce(cause) && cause.happened_in == runs_.back().number;
    });
  }

  /// The first run showed nothing, and the last one brought the name up: chance, or another thing that looks like
  /// it there, would not do so twice.
  bool IsNewsOfOneRun() const {
    const Hypothesis& best = result_.belief.Best().fit.hypothesis;
    if (!best.IsNamed() || result_.steps.size() < 2) return false;
    const auto came_first = [](const Step& step) { return step.believed.front().first; };
    return came_first(result_.steps.front()) == Hypothesis{}.Name() &&
           came_first(*(result_.steps.end() - 2)) != best.Name();
  }

  bool ShouldRepeat() const { return MayHappenAgain() || IsNewsOfOneRun(); }

  /// In runs of the plan that was diagnosed first; mostly the scenario's own.
  double WorthSoFar() const {
    double worth = 0.0;
    for (const TakenRun& run : runs_) worth += WorthOf(run, runs_.front());
    return worth;
  }

  double Faint() const { return options_.faint.value_or(options_.goal ? 0.0 : kUsuallyFaint); }

  /// So many in the mean have the noise in which the cause stands out.
  double RunsToShowFaint() const { return Faint() > 0.0 ? std::pow(kStandsOut / Faint(), 2) : 1.0; }

  /// Makes the run and adds it to what is known.
  void Take(Step& step, const Scenario& scenario) {
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

  void Note(Step step, double entropy_before) {
    const Belief& belief = result_.belief;
    for (const Open& open : belief.open) step.believed.emplace_back(open.fit.hypothesis.Name(), open.probability);
    step.unlisted = belief.unlisted;
    step.u_goal = result_.u_goal;
    step.gained_bit = entropy_before - Entropy_bit(belief.Probabilities());
    result_.steps.push_back(std::move(step));
    if (laboratory_.told) laboratory_.told(result_);
  }

  void TakeFirst() {
    Step step{1, {"first", "the scenario's own run", {}, plan::kSameKind}, "the scenario's own run comes first"};
    Take(step, scenario_);
    const auto taken = [this](const Scenario&) { return runs_.front().readings; };
    RefuseGoalsOutOfReach(scenario_, taken);
    result_.u_goal = certainty_ ? certainty_->u() : kNaN;
    Begin();
    Note(std::move(step), Entropy_bit(result_.belief.Probabilities()));
  }

  /// By the diagnosis of the first run in the list. One without redundancy - two set-ups of one pass - leaves nothing to
  /// find causes by: "nothing" is open, and another run has to come.
  void Begin() {
    not_diagnosed_.clear();
    std::optional<diagnose::DiagnosisRun> found =
        DiagnosisOf(runs_.front().readings, runs_.front().scenario, not_diagnosed_);
    if (!found) found.emplace().diagnosis.verdict = diagnose::Verdict::kNone;
    if (HoldsOutliers(*found)) StrikeOutliers(found->noise, runs_.front());
    result_.belief = Begun(*found, runs_, means_);
    overtones_[runs_.front().asked.sets] = found->overtones;
    if (found->diagnosis.verdict != diagnose::Verdict::kNone) NoteTold();
  }

  static bool HoldsOutliers(const diagnose::DiagnosisRun& found) {
    return std::ranges::any_of(found.diagnosis.causes, [](const diagnose::Cause& cause) {
      return cause.effect == kOutliers && cause.probability > kMostlyOutliers;
    });
  }

  static Hypothesis OutliersIn(Hypothesis hypothesis) {
    std::erase_if(hypothesis.causes, [](const Supposed& cause) { return cause.name != kOutliers; });
    return hypothesis;
  }

  /// Instead of the best. Where readings were struck as outliers they are in no fit, and stay beside whatever is
  /// left.
  static std::vector<Weighed> InsteadOf(const Hypothesis& best, std::vector<Weighed> others) {
    const Hypothesis outliers = OutliersIn(best);
    if (outliers.causes.empty()) return others;
    for (Weighed& other : others) other.hypothesis = Together(outliers, other.hypothesis);
    return others;
  }

  /// Single disturbed readings are others in every run, and no size of any cause: each run's own diagnosis says
  /// which.
  void StrikeOutliersOfLast() {
    if (OutliersIn(result_.belief.Best().fit.hypothesis).causes.empty()) return;
    std::string refusal;
    const auto found = DiagnosisOf(runs_.back().readings, runs_.back().scenario, refusal);
    if (found && HoldsOutliers(*found)) StrikeOutliers(found->noise, runs_.back());
  }

  /// All that is open came from a diagnosis.
  void NoteTold() {
    for (const Open& open : result_.belief.open) told_by_diagnosis_.push_back(open.fit.hypothesis.Name());
  }

  bool WasAnyDiagnosed() const { return not_diagnosed_.empty(); }

  /// @param refusal  Why there is none.
  std::optional<diagnose::DiagnosisRun> DiagnosisOf(const std::vector<Reading>& readings, const Scenario& scenario,
                                                    std::string& refusal) const {
    try {
      return means_.diagnose(readings, scenario, {});
    } catch (const InputError& error) {
      refusal = error.what();
      return std::nullopt;
    }
  }

  /// What nobody can reach is not measured for: first by a run of the twin, then by the first one.
  /// @throws InputError if the results have no such quantity, or standards alone leave more than the goal.
  void RefuseGoalsOutOfReach(const Scenario& scenario,
                             const std::function<std::vector<Reading>(const Scenario&)>& readings_of) {
    if (!certainty_) return;
    const std::vector<Reading> readings = readings_of(scenario);
    const nlohmann::json results = means_.evaluate(readings, scenario);
    if (!Certainty(*options_.goal).Add(results))
      throw InputError("--goal " + options_.goal->Text(), "the first run's results have no such quantity",
                       fmt::format("one of {}", fmt::join(GoalNames(results), ", ")));
    certainty_->Share(BudgetsOf(readings, scenario, means_));
    if (certainty_->SharedU() >= options_.goal->u)
      throw InputError("--goal " + options_.goal->Text(),
                       fmt::format("cannot be reached by any number of runs: what they share leaves {:.3g} {}, most of it {}",
                                   certainty_->SharedU(), options_.goal->unit, certainty_->LargestShared()),
                       "an uncertainty above that, or a better standard");
  }

  /// @return false if it ends here.
  bool TakeNext() {
    if (static_cast<int>(result_.steps.size()) >= options_.most_runs) return End(Ended::kBudget);
    if (!plans_) {
      plans_.emplace(scenario_, means_);
      result_.refused = plans_->refused();
    }
    const double left_min = options_.budget_min - result_.minutes;
    const std::vector<Advice> advice =
        plans_->For(result_.belief, certainty_ ? &*certainty_ : nullptr, runs_, left_min);
    if (!WasAnyDiagnosed()) return TakeToDiagnose(advice);
    if (advice.empty()) return End(Ended::kBudget);
    auto useful = std::ranges::find_if(advice, [this](const Advice& a) { return IsUseful(a); });
    if (useful == advice.end()) useful = Exploring(advice);
    if (useful == advice.end()) useful = LookingCloser(advice);
    if (useful == advice.end()) return End(IsAnyLeftOut(left_min) ? Ended::kBudget : Ended::kNothingMore);
    return TakeConfirmed(*useful, ReasonFor(*useful, advice), advice);
  }

  bool TakeConfirmed(const Advice& chosen, std::string reason, const std::vector<Advice>& advice) {
    Step step{static_cast<int>(result_.steps.size()) + 1, chosen.run, std::move(reason)};
    step.expected_bit = chosen.of_causes_bit;
    if (laboratory_.confirm && !laboratory_.confirm(step, advice)) return End(Ended::kDeclined);
    TakeAndWeigh(std::move(step));
    return true;
  }

  /// The run that tells most of the goal per minute, or the shortest, of those that can be diagnosed.
  /// @throws InputError if there is none within the budget.
  bool TakeToDiagnose(std::vector<Advice> advice) {
    if (!certainty_) std::ranges::stable_sort(advice, {}, &Advice::minutes);
    const auto first = std::ranges::find_if(advice, [this](const Advice& a) { return plans_->CanBeDiagnosed(a.run); });
    if (first == advice.end())
      throw InputError("investigate", "no run that the bench can make within the budget can be diagnosed. " + not_diagnosed_,
                       "another first run, or a longer --budget");
    return TakeConfirmed(*first, "the runs so far cannot be diagnosed: " + not_diagnosed_, advice);
  }

  /// Something is there and nothing open says what any run would show of it: the shortest run of a kind that was not
  /// made yet, to be diagnosed for itself. Or a cause stands alone, but for what the catalogue lacks: there the two
  /// differ, and another such run is made as long as they help.
  std::vector<Advice>::const_iterator Exploring(const std::vector<Advice>& advice) {
    constexpr double kHelps = 0.8;
    auto shortest = advice.end();
    if (AreCausesTold() || !(IsMostlyUnlisted() || IsOnlyUnlistedLeft())) return shortest;
    if (!IsMostlyUnlisted()) {
      if (result_.belief.unlisted > kHelps * unlisted_before_) return shortest;
      unlisted_before_ = result_.belief.unlisted;
    }
    for (auto a = advice.begin(); a != advice.end(); ++a) {
      const bool is_new = a->run.is_of_another_kind && std::ranges::none_of(runs_, [a](const TakenRun& run) {
        return run.asked.sets == a->run.sets;
      });
      if (is_new && (shortest == advice.end() || a->minutes < shortest->minutes)) shortest = a;
    }
    return shortest;
  }

  bool IsMostlyUnlisted() const { return result_.belief.unlisted >= kMostlyUnlisted; }

  bool IsOnlyUnlistedLeft() const {
    const Belief& belief = result_.belief;
    return belief.Best().fit.hypothesis.IsNamed() && belief.unlisted > 1.0 - options_.conclusive && !HasRival(belief);
  }

  /// Where noise may hide what is looked for: what makes it less soonest. Where something may happen again: the
  /// first run once more, or the one that brought it up.
  std::vector<Advice>::const_iterator LookingCloser(const std::vector<Advice>& advice) const {
    if (MayBeFaint()) {
      const auto most = std::ranges::max_element(advice, {}, [](const Advice& a) { return a.worth / a.minutes; });
      return most != advice.end() && most->worth > 0.0 ? most : advice.end();
    }
    if (!AreCausesTold() || !ShouldRepeat()) return advice.end();
    const TakenRun& once_more = MayHappenAgain() ? runs_.front() : runs_.back();
    return std::ranges::find_if(advice,
                                [&once_more](const Advice& a) { return a.run.sets == once_more.asked.sets; });
  }

  bool End(Ended ended) {
    result_.ended = ended;
    return false;
  }

  bool IsUseful(const Advice& a) const {
    const bool tells = !AreCausesTold() && a.of_causes_bit >= kWorthMeasuring_bit && !ArePromisesVain();
    return tells || a.of_goal_bit >= kWorthRefining_bit;
  }

  /// Runs that were to tell causes apart did not. Two that are all but one within the other promise a little each time,
  /// for ever.
  bool ArePromisesVain() const {
    constexpr std::ptrdiff_t kPatience = 6;  // runs
    constexpr double kKept = 0.2;
    if (std::ssize(result_.steps) <= kPatience) return false;
    double expected_bit = 0.0, gained_bit = 0.0;
    for (auto step = result_.steps.end() - kPatience; step != result_.steps.end(); ++step) {
      if (step->expected_bit < kWorthMeasuring_bit) return false;
      expected_bit += step->expected_bit;
      gained_bit += step->gained_bit;
    }
    return gained_bit < kKept * expected_bit;
  }

  /// A run that would tell something takes longer than there is.
  bool IsAnyLeftOut(double left_min) const {
    const double all_min = std::numeric_limits<double>::infinity();
    const bool repeats = AreCausesTold() && ShouldRepeat();
    for (const Advice& a : plans_->For(result_.belief, certainty_ ? &*certainty_ : nullptr, runs_, all_min)) {
      if (a.minutes > left_min && (IsUseful(a) || repeats || (MayBeFaint() && a.worth > 0.0))) return true;
    }
    return false;
  }

  std::string ReasonFor(const Advice& best, const std::vector<Advice>& advice) const {
    std::string reason;
    if (!AreCausesTold())
      reason = fmt::format("{:.2f} bit of {:.2f} that are open about the causes", best.of_causes_bit,
                           Entropy_bit(result_.belief.Probabilities()));
    if (best.of_goal_bit > 0.0)
      reason += fmt::format("{}{} to {:.3g}", reason.empty() ? "" : ", ", result_.goal->Text(), best.u_goal);
    if (!IsUseful(best)) return ReasonToLook();
    reason += fmt::format(" expected in {:.1f} min", best.minutes);
    const auto second = std::ranges::find_if(advice, [&](const Advice& a) { return a.run.name != best.run.name; });
    if (second == advice.end()) return reason;
    return reason + fmt::format("; per minute the next best, {}, has {:.2g} times as much", second->run.name,
                                second->PerMinute() / best.PerMinute());
  }

  /// For a run that no open hypothesis asks for.
  std::string ReasonToLook() const {
    const std::string name = result_.belief.Best().fit.hypothesis.Name();
    if (AreCausesTold() && MayHappenAgain())
      return fmt::format("{} happened in the last run: whether it does so again", name);
    if (AreCausesTold() && IsNewsOfOneRun())
      return fmt::format("only the last run brought {} up: whether it does so again", name);
    if (IsOnlyUnlistedLeft())
      return fmt::format("nothing else in the catalogue explains it as {} does: the shortest run of a kind that was not "
                         "made yet, where what no catalogue lists would differ",
                         name);
    if (!MayBeFaint()) return "nothing open says what this is: the shortest run of a kind that was not made yet";
    return fmt::format(
        "nothing found so far: {:.3g} runs like the first together show what is {:.3g} standard deviations strong in one, {:.3g} "
        "are there, and nothing else makes the noise less so soon",
        RunsToShowFaint(), Faint(), WorthSoFar());
  }

  void TakeAndWeigh(Step step) {
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
  static bool IsNew(const std::string& name, std::vector<std::string>& noted) {
    if (std::ranges::find(noted, name) != noted.end()) return false;
    noted.push_back(name);
    return true;
  }

  /// A name that fits of all runs brought up and no diagnosis: what else would look like it is asked for, and some of it
  /// the catalogue lacks. That run says nothing against doubles of its own.
  void DoubtAName() {
    Belief& belief = result_.belief;
    const Hypothesis best = belief.Best().fit.hypothesis;
    if (!best.IsNamed() || !IsNew(best.Name(), told_by_diagnosis_)) return;
    const TakenRun& run = runs_.back();
    if (const auto& alone = LastAlone(best))
      TakeIn(belief, InsteadOf(best, LeftOpen(WithLessLikely(*alone), run.scenario, run.number)), runs_, means_,
             [this](const Hypothesis& other) { return AsMany(other); });
    NamedByFits(belief);
  }

  /// A name that comes first has every other cause of the catalogue held against all runs, once: one that a diagnosis of
  /// few runs found too unlikely to carry on may be what all of them together say.
  void AskOthers() {
    Belief& belief = result_.belief;
    const Hypothesis best = belief.Best().fit.hypothesis;
    if (!best.IsNamed() || best.causes.size() > 1 || !IsNew(best.Name(), held_against_others_)) return;
    const TakenRun& run = runs_.back();
    const auto& alone = LastAlone(best);
    if (!alone) return;
    for (const Weighed& other : InsteadOf(best, EachAlone(*alone, run.scenario, run.number)))
      TakeIn(belief, {other}, runs_, means_, [this](const Hypothesis& one) { return AsMany(one); });
  }

  /// That a wave fits all runs alike says nothing of its form: what repeats and is no sine does so too. The last run, and
  /// all like it, are asked for overtones; what other plans' runs said of them counts as well.
  void DoubtAWave() {
    const Hypothesis best = result_.belief.Best().fit.hypothesis;
    const auto is_wave = [](const Supposed& cause) { return cause.parameters.contains("frequency"); };
    if (!best.IsNamed() || std::ranges::none_of(best.causes, is_wave)) return;
    if (const auto& alone = LastAlone(best)) overtones_[runs_.back().asked.sets] = alone->overtones;
    Disagreed(result_.belief, ProbabilityOfNoSine(overtones_));
  }

  /// Diagnosis of the last run, and all like it, beside the scenario as it stands. None where it cannot be diagnosed.
  const std::optional<diagnose::DiagnosisRun>& LastAlone(const Hypothesis& best) {
    const bool is_mean = std::ranges::none_of(best.causes, HappensOnce);
    if (alone_.runs == runs_.size() && alone_.is_mean == is_mean) return alone_.found;
    std::string refusal;
    alone_ = {runs_.size(), is_mean, DiagnosisOf(WithThoseLike(runs_.back(), best), runs_.back().scenario, refusal)};
    return alone_.found;
  }

  /// The last run, and all like it together, beside the best hypothesis: they agree, or they bring up more.
  void Compare() {
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
    std::vector<Weighed> more = LeftOpen(WithLessLikely(found), with, run.number);  // where nothing is found: what would come first
    std::erase_if(more, [](const Weighed& one) { return one.hypothesis.causes.empty(); });
    for (Weighed& one : more) one.hypothesis = Together(best, one.hypothesis);
    bool is_new = TakeIn(belief, more, runs_, means_, [&best](const Hypothesis&) { return best; });
    if (agrees) return;
    if (best.IsNothing()) alone_ = {runs_.size(), true, found};
    const auto& last = LastAlone(best);
    const diagnose::DiagnosisRun& alone = last ? *last : found;
    const std::vector<Weighed> others =  // instead of the best; beside nothing that was just asked
        InsteadOf(best, LeftOpen(WithLessLikely(alone), run.scenario, run.number));
    is_new = TakeIn(belief, others, runs_, means_, [this](const Hypothesis& other) { return AsMany(other); }) || is_new;
    // Several causes together are a coincidence that one without a name does not need.
    if (belief.Best().fit.hypothesis.causes.size() > 1) Disagreed(belief, UnlistedBy(alone));
    if (!is_new || found.diagnosis.verdict == diagnose::Verdict::kUnknown)
      Disagreed(belief, UnlistedBy(found));
  }

  /// The mean of the runs of its plan: it shows smaller causes than any of them. What happened once did so in one of
  /// them, and another is behind it.
  std::vector<Reading> WithThoseLike(const TakenRun& run, const Hypothesis& best) const {
    if (std::ranges::any_of(best.causes, HappensOnce)) return run.readings;
    std::vector<const std::vector<Reading>*> alike;
    for (const TakenRun& other : runs_) {
      if (other.asked.sets == run.asked.sets) alike.push_back(&other.readings);
    }
    return diagnose::MeanOfRuns(alike, FormatOf(run.scenario.bench)).value_or(run.readings);
  }

  bool IsOfAnotherKind() const {
    if (!runs_.back().asked.is_of_another_kind) return false;
    return std::none_of(runs_.begin(), runs_.end() - 1,
                        [this](const TakenRun& run) { return run.asked.sets == runs_.back().asked.sets; });
  }

  /// The most probable one that is open of so many causes, with names if it has them; else the best there is. What
  /// comes up anew is weighed by its evidence against that one's: the weights of others may stand for fits that are
  /// no good.
  Hypothesis AsMany(const Hypothesis& hypothesis) const {
    const Hypothesis* of_as_many = nullptr;
    for (const Open& open : result_.belief.open) {
      const Hypothesis& other = open.fit.hypothesis;
      if (other.causes.size() != hypothesis.causes.size()) continue;
      if (other.IsNamed() == hypothesis.IsNamed()) return other;
      if (!of_as_many) of_as_many = &other;
    }
    return of_as_many ? *of_as_many : result_.belief.Best().fit.hypothesis;
  }

  const Scenario& scenario_;
  const InvestigationOptions& options_;
  const Means& means_;
  const Laboratory& laboratory_;
  std::optional<Certainty> certainty_;
  std::optional<Plans> plans_;  // once they are needed: each is a run of the twin
  std::vector<TakenRun> runs_;
  std::string not_diagnosed_;     // why none of the runs so far could be
  std::vector<std::string> told_by_diagnosis_;    // names whose rivals and doubles a diagnosis was asked for
  std::vector<std::string> held_against_others_;  // of the whole catalogue
  struct {
    std::size_t runs = 0;
    bool is_mean = false;
    std::optional<diagnose::DiagnosisRun> found;
  } alone_;  // LastAlone
  Overtones overtones_;
  double unlisted_before_ = std::numeric_limits<double>::infinity();  // the last run that was made for it alone
  Investigation result_;
};

}  // namespace

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
