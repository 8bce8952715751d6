#include "twin/benches/encoder_comparison/diagnosis/large_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/benches/encoder_comparison/diagnosis/ties.h"
#include "twin/benches/encoder_comparison/diagnosis/wander.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

/// A function of the angle, whichever way it goes.
bool IsOfAngle(const EffectSettings& effect) {
  constexpr std::array kOfTurn = {"eccentricity", "ellipticity", "signal_offset", "amplitude_mismatch", "quadrature_error"};
  return WaveOrderOf(effect) || std::ranges::count(kOfTurn, effect.name) > 0;
}

/// As if what was found were not there.
void TellNothing(Searched& searched) {
  searched.analysis.found.first_statistic = searched.analysis.found.last_statistic;
}

}  // namespace

void LargeSearch::EndTies() {
  if (large_.causes.empty()) return;
  FittedCauses now = fit_->Fit(large_.causes);
  if (SettleTies(*fit_, now)) {
    Accept(now.asked, std::move(now.causes), kMostCauses);
    LeaveToLarge();
  } else {
    large_.causes = std::move(now.causes);
  }
}

/// A wave of an order that a large cause has is what that lacks beside the others that the last search found; what is
/// less than a device is as exact as its formula is no cause, nor is what the memory of the rest makes by chance, nor what
/// large causes are not exactly.
void LargeSearch::LeaveToLarge() {
  Searched& last = large_.last ? *large_.last : *large_.first;
  std::vector<Term>& terms = last.analysis.found.terms;
  const SecondOrder bent = Bent();
  if (std::erase_if(terms, [&](const Term& term) { return bent.MayBe(term.columns * term.amplitudes); }) > 0 && terms.empty())
    TellNothing(last);
  if (terms.empty() || (large_.causes.empty() && written_.empty())) return;
  const double least = LeastExplained();
  const Eigen::VectorXd left = Left(LeftByTerms());
  const double apart = OrdersApart(last.encoder.context);
  const auto is_of_large = [&](const Term& term) {
    const Family& family = last.families[static_cast<std::size_t>(term.family)];
    return std::ranges::any_of(large_.causes, [&](const LargeCause& cause) {
      const std::optional<double> order = WaveOrderOf(cause.effect);
      return cause.effect.name == family.effect && term.shape.size() == 1 && order && std::abs(*order - term.shape[0]) < apart;
    });
  };
  // In motion two loops show anything, one against the other.
  const bool has_loop = last.encoder.context.Moves() &&
                        std::ranges::any_of(large_.causes, [](const LargeCause& cause) { return IsLoop(cause.effect.name); });
  double least_odd = 0.0;  // passes of both directions tell it from what is the same in them
  for (const LargeCause& cause : large_.causes) least_odd += IsOfAngle(cause.effect) ? 0.0 : kAsExact * cause.explained;
  for (const Written& written : written_) least_odd += IsOfAngle(written.effect) ? 0.0 : kAsExact * written.explained;
  std::erase_if(terms, [&](const Term& term) {
    const bool is_odd = last.families[static_cast<std::size_t>(term.family)].effect.starts_with("direction");
    const std::string& effect = last.families[static_cast<std::size_t>(term.family)].effect;
    if (has_loop && IsLoop(effect)) return true;
    return term.explained < (is_odd ? least_odd : least) || is_of_large(term) || LeadsBesideLatency(effect, term.amplitudes[0], large_.causes) || IsChance(term, left);
  });
  if (large_.causes.empty() && terms.empty()) TellNothing(last);
}


/// Of what was found before, too: a file that was written has no more than the first order.
SecondOrder LargeSearch::Bent() const {
  std::vector<EffectSettings> effects = EffectsOf(large_.causes);
  for (const Written& written : written_) effects.push_back(written.effect);
  return {effects, large_.first->encoder};
}

/// What an earlier diagnosis wrote is no more exact than what this one takes.
void LargeSearch::WeighWritten() {
  for (std::size_t k = 0; k < scenario_.effects.size(); ++k) {
    if (scenario_.effects[k].finding.provenance.empty()) continue;
    Scenario without = scenario_;
    without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(k));
    const EncoderRun& encoder = large_.first->encoder;
    const Eigen::VectorXd left =
        encoder.error_rad - FollowTwin(encoder, without, follow_, encoder.offset_rad).error_rad;
    written_.push_back({scenario_.effects[k], std::max(0.0, fit_->PowerOf(left) - power_)});
  }
}

/// What all large causes explain together is exact to this, with those that the scenario has of an earlier diagnosis: what
/// that left out, in a noise that it knew less well, is not taken by this one.
double LargeSearch::LeastExplained() const {
  constexpr double kAgain = 1.5;
  double explained = 0.0;
  for (const Written& written : written_) explained += kAgain * written.explained;
  for (const LargeCause& cause : large_.causes) explained += cause.explained;
  return kAsExact * explained;
}

/// What the large causes leave of what the others do, whitened.
Eigen::VectorXd LargeSearch::Left(const Eigen::VectorXd& beside) const {
  return fit_->WhiteOf(large_.causes.empty() ? beside : fit_->Ask(large_.causes, beside).left);
}

/// @param left  With a random walk in it (LeftByTerms), which is no noise beside itself.
bool LargeSearch::IsChance(const Term& term, const Eigen::VectorXd& left) const {
  const Eigen::VectorXd shown = term.columns * term.amplitudes, own = fit_->WhiteOf(shown);
  const bool is_walk = FollowsWalk(large_.Last().families[static_cast<std::size_t>(term.family)], term.columns);
  const Eigen::VectorXd others = is_walk ? Left(LeftByTerms() - shown) : left;
  const double noise = others.squaredNorm() / static_cast<double>(others.size());
  return own.squaredNorm() < std::pow(tuning::kHeadline, 2) * noise * MemoryAlong(own, others);
}

/// What stood for something that was found later is not kept, nor what the memory of the rest makes by chance: the
/// weakest first, for what it kept from being found may be what made others look weak. The rest is searched again when all are
/// strong beside what it was.
void LargeSearch::DropNeedless() {
  for (;;) {
    std::vector<LargeCause> kept = large_.causes;
    while (!kept.empty()) {
      const std::vector<double> strength = Strengths(kept);
      const double weakest = std::ranges::min(strength);
      if (weakest > tuning::kHeadline) break;
      std::vector<LargeCause> stronger;
      for (std::size_t k = 0; k < strength.size(); ++k) {
        if (strength[k] > weakest) stronger.push_back(kept[k]);  // those that are none at all go together
      }
      kept = std::move(stronger);
      if (!kept.empty()) TakeOver(fit_->Ask(kept), kept);
    }
    if (kept.size() == large_.causes.size()) return;
    if (kept.empty()) return SearchPlain();
    if (!TakeInstead(std::move(kept))) return;
  }
}

/// Of each large cause, how many of its uncertainties it is away from nothing, with the memory of the rest; 0 of what
/// is less than the others are as exact as their formula.
std::vector<double> LargeSearch::Strengths(const std::vector<LargeCause>& causes) const { return Strengths(causes, LeftByTerms()); }

/// @param rows  That they have to explain.
std::vector<double> LargeSearch::Strengths(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows) const {
  const AskedAgain beside = fit_->Ask(causes, rows);
  const Eigen::VectorXd left = fit_->WhiteOf(beside.left);
  const double memory = fit_->Memory(beside.left), least = LeastExplained();
  // Beside the rest a fit may end where the twin shows nothing.
  const bool is_possible = fit_->Shown(beside.effects).allFinite();
  const std::vector<EffectSettings> effects = is_possible ? beside.effects : EffectsOf(causes);
  std::vector<double> strengths;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const Eigen::VectorXd shown = fit_->Shown(effects) - fit_->Shown(EffectsWithout(k, effects)), own = fit_->WhiteOf(shown);
    const double most = std::max(IsLoop(effects[k].name) ? MemoryOfLoop(shown, beside.left, memory) : memory, MemoryAlong(own, left));
    strengths.push_back(own.squaredNorm() > least ? Deviations(causes[k].effect) / std::sqrt(most) : 0.0);
  }
  return strengths;
}

/// Nothing of it was there: for all at once, as if nothing had been large.
void LargeSearch::SearchPlain() {
  large_.causes.clear();
  large_.last.reset();
  slopes_.resize(0, 0);
  most_searched_ = kFewCauses;
  SearchOn();
  if (IsNothingButWalk(large_.first->encoder.run)) return large_.first->analysis.found.terms.clear();
  if (!TakeOneOfTwoWaves()) return;
  while (SearchOn()) TakeLarge();
  LeaveToLarge();
}

/// What was taken while others were missing may have looked like a shape without a name: it is judged anew beside all
/// of them.
void LargeSearch::JudgeUnsure() {
  constexpr double kSure = 0.8;
  for (std::size_t k = 0; k < large_.causes.size(); ++k) {
    std::vector<Cause>& members = large_.causes[k].causes;
    double together = 0.0;
    for (const Cause& cause : members) together += cause.probability;
    if (together > kSure) continue;
    for (const Cause& now : InPlaceOf(k)) {
      const auto member = std::ranges::find_if(
          members, [&](const Cause& m) { return m.effect == now.effect && m.where == now.where; });
      if (member != members.end()) member->probability = std::max(member->probability, now.probability);
    }
  }
}

/// What a search names in the place of the k-th cause, with all others there.
std::vector<Cause> LargeSearch::InPlaceOf(std::size_t k) const {
  const std::vector<EffectSettings> others = EffectsWithout(k, EffectsOf(large_.causes));
  EncoderRun encoder = RunWith(others);
  encoder.run.sigma = large_.Last().encoder.run.sigma;
  for (const Term& term : large_.Last().analysis.found.terms) encoder.run.residual -= term.columns * term.amplitudes;
  AnalysisOptions how = For(1);
  how.largest_only = false;  // which would leave the place to a name
  const auto searched = SearchIn(std::move(encoder), options_.excluded, how);
  if (searched->analysis.found.terms.empty()) return {};
  return AnswerOf(searched->analysis.found, 0, searched->families).causes;
}

/// What is left for the large causes once the last search has explained the rest. A random walk is noise beside them: its many
/// shapes would follow whatever they miss.
/// @param but  Whose terms are not taken off.
Eigen::VectorXd LargeSearch::LeftByTerms(const Cause* but) const {
  Eigen::VectorXd rows = large_.first->encoder.run.residual;
  const Searched& last = large_.Last();
  for (const Term& term : last.analysis.found.terms) {
    const Family& family = last.families[static_cast<std::size_t>(term.family)];
    if (!FollowsWalk(family, term.columns) && !(but && IsOf(*but, family))) rows -= term.columns * term.amplitudes;
  }
  return rows;
}

void LargeSearch::TellWhatEachShows() {
  std::vector<EffectSettings> effects;
  Eigen::VectorXd before = Eigen::VectorXd::Zero(fit_->Run().run.Rows());
  for (LargeCause& cause : large_.causes) {
    effects.push_back(cause.effect);
    const Eigen::VectorXd shown = fit_->Shown(effects);
    cause.shown = shown - before;
    before = shown;
  }
}

void LargeSearch::TellWhatNamesLeave() {
  const Searched& last = large_.Last();
  Eigen::VectorXd rows = large_.first->encoder.run.residual;
  for (const LargeCause& cause : large_.causes) rows -= cause.shown;
  for (const Term& term : last.analysis.found.terms) {
    if (last.families[static_cast<std::size_t>(term.family)].kind == Kind::kNamed) rows -= term.columns * term.amplitudes;
  }
  large_.left = power_;
  large_.named_left = fit_->PowerOf(rows);
  large_.memory = fit_->Memory(rows);
}

}  // namespace twinbench::diagnose::encoder
