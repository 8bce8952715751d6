#include <fmt/format.h>

#include <algorithm>

#include "twin/core/errors.h"
#include "twin/investigate/expected_information.h"
#include "twin/investigate/loop.h"

namespace twinbench::investigate {
namespace {

constexpr double kWorthMeasuring_bit = 0.05;  // of causes
constexpr double kWorthRefining_bit = 0.005;  // of the goal

}  // namespace

/// @return false if it ends here.
bool Loop::TakeNext() {
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

bool Loop::TakeConfirmed(const Advice& chosen, std::string reason, const std::vector<Advice>& advice) {
  Step step{static_cast<int>(result_.steps.size()) + 1, chosen.run, std::move(reason)};
  step.expected_bit = chosen.of_causes_bit;
  if (laboratory_.confirm && !laboratory_.confirm(step, advice)) return End(Ended::kDeclined);
  TakeAndWeigh(std::move(step));
  return true;
}

/// The run that tells most of the goal per minute, or the shortest, of those that can be diagnosed.
/// @throws InputError if there is none within the budget.
bool Loop::TakeToDiagnose(std::vector<Advice> advice) {
  if (!certainty_) std::ranges::stable_sort(advice, {}, &Advice::minutes);
  const auto first =
      std::ranges::find_if(advice, [this](const Advice& a) { return plans_->CanBeDiagnosed(a.run); });
  if (first == advice.end())
    throw InputError("investigate",
                     "no run that the bench can make within the budget can be diagnosed. " + not_diagnosed_,
                     "another first run, or a longer --budget");
  return TakeConfirmed(*first, "the runs so far cannot be diagnosed: " + not_diagnosed_, advice);
}

/// Something is there and nothing open says what any run would show of it: the shortest run of a kind that was not
/// made yet, to be diagnosed for itself. Or a cause stands alone, but for what the catalogue lacks: there the two
/// differ, and another such run is made as long as they help.
std::vector<Advice>::const_iterator Loop::Exploring(const std::vector<Advice>& advice) {
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

bool Loop::IsOnlyUnlistedLeft() const {
  const Belief& belief = result_.belief;
  return belief.Best().fit.hypothesis.IsNamed() && belief.unlisted > 1.0 - options_.conclusive && !HasRival(belief);
}

/// Where noise may hide what is looked for: what makes it less soonest. Where something may happen again: the
/// first run once more, or the one that brought it up.
std::vector<Advice>::const_iterator Loop::LookingCloser(const std::vector<Advice>& advice) const {
  if (MayBeFaint()) {
    const auto most = std::ranges::max_element(advice, {}, [](const Advice& a) { return a.worth / a.minutes; });
    return most != advice.end() && most->worth > 0.0 ? most : advice.end();
  }
  if (!AreCausesTold() || !ShouldRepeat()) return advice.end();
  const TakenRun& once_more = MayHappenAgain() ? runs_.front() : runs_.back();
  return std::ranges::find_if(advice, [&once_more](const Advice& a) { return a.run.sets == once_more.asked.sets; });
}

bool Loop::IsUseful(const Advice& a) const {
  const bool tells = !AreCausesTold() && a.of_causes_bit >= kWorthMeasuring_bit && !ArePromisesVain();
  return tells || a.of_goal_bit >= kWorthRefining_bit;
}

/// Runs that were to tell causes apart did not. Two that are all but one within the other promise a little each
/// time, for ever.
bool Loop::ArePromisesVain() const {
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
bool Loop::IsAnyLeftOut(double left_min) const {
  const double all_min = std::numeric_limits<double>::infinity();
  const bool repeats = AreCausesTold() && ShouldRepeat();
  for (const Advice& a : plans_->For(result_.belief, certainty_ ? &*certainty_ : nullptr, runs_, all_min)) {
    if (a.minutes > left_min && (IsUseful(a) || repeats || (MayBeFaint() && a.worth > 0.0))) return true;
  }
  return false;
}

std::string Loop::ReasonFor(const Advice& best, const std::vector<Advice>& advice) const {
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
std::string Loop::ReasonToLook() const {
  const std::string name = result_.belief.Best().fit.hypothesis.Name();
  if (AreCausesTold() && MayHappenAgain())
    return fmt::format("{} happened in the last run: whether it does so again", name);
  if (AreCausesTold() && IsNewsOfOneRun())
    return fmt::format("only the last run brought {} up: whether it does so again", name);
  if (IsOnlyUnlistedLeft())
    return fmt::format(
        "nothing else in the catalogue explains it as {} does: the shortest run of a kind that was not "
        "made yet, where what no catalogue lists would differ",
        name);
  if (!MayBeFaint()) return "nothing open says what this is: the shortest run of a kind that was not made yet";
  return fmt::format(
      "nothing found so far: {:.3g} runs like the first together show what is {:.3g} standard deviations strong in "
      "one, {:.3g} "
      "are there, and nothing else makes the noise less so soon",
      RunsToShowFaint(), Faint(), WorthSoFar());
}

}  // namespace twinbench::investigate
