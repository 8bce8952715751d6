#include "twin/investigate/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "twin/core/effect_catalogue.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::investigate {
namespace {

/// Less is not carried on.
constexpr double kNegligible = 1e-4;

void Normalise(Belief& belief) {
  double most = -std::numeric_limits<double>::infinity();
  const auto weight = [](const Open& open) { return open.fit.hypothesis.log_prior + open.fit.log_evidence; };
  for (const Open& open : belief.open) most = std::max(most, weight(open));
  double sum = 0.0;
  for (const Open& open : belief.open) sum += std::exp(weight(open) - most);
  for (Open& open : belief.open) open.probability = (1.0 - belief.unlisted) * std::exp(weight(open) - most) / sum;
  std::ranges::stable_sort(belief.open, std::ranges::greater{}, &Open::probability);
  std::erase_if(belief.open, [&belief](const Open& open) {
    return open.probability < kNegligible && &open != &belief.open.front();
  });
}

/// Named causes share what is left when the most of `unlisted` has gone to signals without a name.
void AddUnnamed(std::vector<Weighed>& open, Belief& belief, const TakenRun& first, const Means& means) {
  constexpr double kAsSignals = 0.9;
  const std::vector<std::string> named = EffectsIn(open);
  if (named.empty() || belief.unlisted <= kNegligible) return;
  const Hypothesis unnamed = Unnamed(means.diagnose(first.readings, first.scenario, named), first.scenario);
  if (unnamed.causes.empty()) return;
  const double as_signals = kAsSignals * belief.unlisted, rest = belief.unlisted - as_signals;
  for (Weighed& one : open) one.probability *= (1.0 - belief.unlisted) / (1.0 - rest);
  open.push_back({unnamed, as_signals / (1.0 - rest)});
  belief.unlisted = rest;
}

/// More runs may show other sizes of the same causes - another order of a wave - than those that were fitted from the
/// first one on. @return whether they explain all runs better.
bool FitAnew(const Hypothesis& from, const std::vector<TakenRun>& runs, const Means& means, JointFit& fit) {
  constexpr double kBetter = 1.0;  // of log evidence
  JointFit anew = FitJointly(from, runs, means);
  if (anew.log_evidence < fit.log_evidence + kBetter) return false;
  anew.hypothesis.log_prior = fit.hypothesis.log_prior;
  fit = std::move(anew);
  return true;
}

/// A weight over the evidence of the runs that it was drawn from.
void WeighBy(double log_weight, std::size_t runs, Open& open) {
  open.by = {runs, open.fit.chi2, open.fit.log_evidence};
  open.fit.hypothesis.log_prior = log_weight - open.fit.log_evidence;
}

/// Sizes that later runs led to may fit the runs of its weight better than the ones that were found then - a slow decay
/// where a fast one was tried. Their evidence was in the weight already: it is no news that they bring.
void WeighByBetterSizes(const std::vector<TakenRun>& runs, const Means& means, Open& open) {
  constexpr double kBetter = 1.0;  // of chi2
  const std::span<const TakenRun> then = std::span(runs).first(std::min(open.by.runs, runs.size()));
  if (then.empty() || Chi2Of(open.fit.hypothesis, then, means) > open.by.chi2 - kBetter) return;
  const JointFit better = FitJointly(open.fit.hypothesis, then, means);
  if (better.log_evidence <= open.by.log_evidence) return;
  open.fit.hypothesis.log_prior -= better.log_evidence - open.by.log_evidence;
  open.by = {open.by.runs, better.chi2, better.log_evidence};
}

/// Of one further cause of the catalogue against none.
double LogOddsOfOne(const std::string& bench) {
  const double causes = static_cast<double>(std::max<std::size_t>(1, EffectCatalogue(bench).size()));
  return std::log(diagnose::tuning::kPriorNamed / diagnose::tuning::kPriorNone / causes);
}

}  // namespace

std::vector<double> Belief::Probabilities() const {
  std::vector<double> probabilities;
  for (const Open& one : open) probabilities.push_back(one.probability);
  probabilities.push_back(unlisted);
  return probabilities;
}

Belief Begun(const diagnose::DiagnosisRun& found, const std::vector<TakenRun>& runs, const Means& means) {
  Belief belief;
  const std::span<const TakenRun> diagnosed = std::span(runs).first(1);
  belief.unlisted = UnlistedBy(found);
  std::vector<Weighed> open = LeftOpen(WithLessLikely(found), runs.front().scenario, runs.front().number);
  AddUnnamed(open, belief, runs.front(), means);
  for (const Weighed& weighed : open) {
    Open fitted{FitJointly(weighed.hypothesis, diagnosed, means)};
    WeighBy(std::log(std::max(weighed.probability, kNegligible)), diagnosed.size(), fitted);
    belief.open.push_back(std::move(fitted));
  }
  Normalise(belief);
  return belief;
}

void Update(Belief& belief, const std::vector<TakenRun>& runs, const Means& means) {
  for (Open& open : belief.open) {
    open.fit = FitJointly(open.fit.hypothesis, runs, means);
    WeighByBetterSizes(runs, means, open);
  }
  Normalise(belief);
}

bool TakeIn(Belief& belief, const std::vector<Weighed>& found, const std::vector<TakenRun>& runs, const Means& means,
            const std::function<Hypothesis(const Hypothesis&)>& beside) {
  const double odds = LogOddsOfOne(runs.front().scenario.bench);
  const std::size_t before = belief.open.size();
  std::vector<double> logs;  // of the weights that they are to have beside each other
  bool is_better = false;
  for (const Weighed& one : found) {
    if (one.hypothesis.causes.empty()) continue;
    const auto there = std::ranges::find_if(
        belief.open, [&one](const Open& open) { return IsSame(open.fit.hypothesis, one.hypothesis); });
    if (there != belief.open.end()) {
      if (!FitAnew(one.hypothesis, runs, means, there->fit)) continue;
      WeighByBetterSizes(runs, means, *there);
      is_better = true;
      continue;
    }
    Open open{FitJointly(one.hypothesis, runs, means)};
    const Hypothesis other = beside(one.hypothesis);
    const double more = static_cast<double>(one.hypothesis.causes.size()) - static_cast<double>(other.causes.size());
    open.fit.hypothesis.log_prior = other.log_prior + more * odds;
    logs.push_back(std::log(std::max(one.probability, kNegligible)));
    belief.open.push_back(std::move(open));
  }
  if (logs.empty()) {
    if (is_better) Normalise(belief);
    return is_better;
  }
  const std::span<Open> taken(belief.open.begin() + static_cast<std::ptrdiff_t>(before), belief.open.end());
  const auto weight = [](const Open& open) { return open.fit.hypothesis.log_prior + open.fit.log_evidence; };
  const auto best = std::ranges::max_element(taken, {}, weight);
  const double most = weight(*best) - logs[static_cast<std::size_t>(best - taken.begin())];
  for (std::size_t k = 0; k < taken.size(); ++k) {
    if (&taken[k] != &*best) WeighBy(most + logs[k], runs.size(), taken[k]);
  }
  Normalise(belief);
  return true;
}

double MimicFactor(const Hypothesis& best, const TakenRun& run, const Means& means) {
  const Eigen::VectorXd left = LeftBy(best, run, means), shown = run.left - left;
  const double length = Product(run, shown, shown)(0, 0), along = Product(run, shown, left)(0, 0);
  constexpr double kMost = 20.0;  // beyond that nothing is left of the best hypothesis
  return std::exp(std::min(kMost, 0.5 * along * along / (1.0 + length))) / std::sqrt(1.0 + length);
}

void Agreed(Belief& belief, const TakenRun& run, const Means& means) {
  const double factor = MimicFactor(belief.Best().fit.hypothesis, run, means);
  const double odds = factor * belief.unlisted / std::max(1.0 - belief.unlisted, kNegligible);
  belief.unlisted = odds / (1.0 + odds);
  Normalise(belief);
}

void NamedByFits(Belief& belief) {
  Disagreed(belief, 1.0 - diagnose::tuning::kListed);
}

double ProbabilityOfNoSine(const Overtones& overtones) {
  constexpr double kCertain = 1.0 - 1e-9;
  double odds = diagnose::tuning::kNoSine;
  for (const auto& [plan, probability] : overtones) {
    const double p = std::min(probability, kCertain);
    if (p > 0.0) odds *= p / (1.0 - p) / diagnose::tuning::kNoSine;
  }
  return odds / (1.0 + odds);
}

void Disagreed(Belief& belief, double unknown) {
  belief.unlisted = std::max(belief.unlisted, std::clamp(unknown, 0.0, 1.0));
  Normalise(belief);
}

}  // namespace twinbench::investigate
