#include "twin/benches/encoder_comparison/diagnosis/large_search.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <string>
#include <utility>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/loop_in_walk.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_block.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_guess.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/motion.h"

/// What is large, one after the other.
namespace twinbench::diagnose::encoder {
namespace {

constexpr std::size_t kMostLarge = 16;

/// The wave of this order that is what both are together in the middle of the readings.
LargeCause SumOfWaves(LargeCause wave, const LargeCause& more, double order, double middle_rad) {
  std::complex<double> sum;
  for (const LargeCause* part : {&std::as_const(wave), &more}) {
    const double phase_rad = part->effect.parameters.at("phase") + *WaveOrderOf(part->effect) * middle_rad;
    sum += std::polar(part->effect.parameters.at("amplitude"), phase_rad);
  }
  std::map<std::string, double>& of = wave.effect.parameters;
  of["order"] = order;
  of["amplitude"] = std::abs(sum);
  of["phase"] = std::arg(sum) - order * middle_rad;
  return wave;
}

/// Whether a latency that is a delay alone, or a lag alone, leaves another rest than the other would.
bool IsSeenInAcceleration(const EffectSettings& latency, const EncoderRun& encoder) {
  constexpr double kHardly = 0.1;  // of the noise of a reading
  const double delay_s = latency.parameters.at("delay"), lag_s = latency.parameters.at("time_constant");
  if (delay_s < 0.0 || (delay_s > 0.0) == (lag_s > 0.0)) return false;
  const Eigen::VectorXd acceleration_rad_s2 = model::RateOfChange(encoder.run.schedule, encoder.context.velocity_rad_s);
  const double apart_rad = 0.5 * std::pow(delay_s + lag_s, 2) * acceleration_rad_s2.norm() / std::sqrt(encoder.run.Rows());
  return apart_rad > kHardly * encoder.run.sigma.mean();
}

}  // namespace

/// What the loop leaves is the walk, or noise that remembers: neither has a shape.
void LargeSearch::TakeLoopInWalk() {
  large_.first->analysis.found.terms.clear();
  const std::vector<LargeCause> loops = LoopsInWalk(*large_.first, fit_->projector());
  const auto left = [this](const LargeCause& loop) { return fit_->PowerOf(fit_->Ask({loop}).left); };
  const auto least = std::ranges::min_element(loops, {}, left);
  if (least == loops.end() || !Take(*least)) return;
  Searched& last = *large_.last;
  std::erase_if(last.analysis.found.terms, [&](const Term& term) { return last.families[static_cast<std::size_t>(term.family)].kind == Kind::kUnknown; });
}

/// Signals that are cut off have all their faults at once: none of them is found alone.
void LargeSearch::TakeSignals() {
  const EncoderRun& encoder = large_.first->encoder;
  if (power_ < kLarge * kLarge || std::ranges::count(options_.excluded, "signal_clipping") > 0) return;
  const std::optional<SignalGuess> guess = GuessSignals(encoder.context, encoder.run.residual);
  if (!guess) return;
  TakeBlock(SignalBlock(*guess, encoder, options_.excluded));
}

/// A delay that is too long for the speed to tell, and the gain that comes with it.
void LargeSearch::TakeLag() {
  const EncoderRun& encoder = large_.first->encoder;
  const auto is_excluded = [this](const char* name) { return std::ranges::count(options_.excluded, name) > 0; };
  if (power_ < kLarge * kLarge || !large_.causes.empty() || is_excluded("latency") || is_excluded("scale")) return;
  if (const std::optional<LagGuess> guess = GuessLag(encoder, large_.first->families)) TakeBlock(LagBlock(*guess, encoder));
}

/// What is late by a delay may be late by a lag as well, where the acceleration shows which.
void LargeSearch::TakeOtherLag() {
  const EncoderRun& encoder = large_.first->encoder;
  const auto latency = std::ranges::find(large_.causes, "latency", [](const LargeCause& cause) { return cause.effect.name; });
  if (latency == large_.causes.end() || !encoder.context.has_clock || !IsSeenInAcceleration(latency->effect, encoder)) return;
  std::vector<LargeCause> causes = large_.causes;
  LargeCause& other = causes[static_cast<std::size_t>(latency - large_.causes.begin())];
  std::map<std::string, double>& of = other.effect.parameters;
  std::swap(of["delay"], of["time_constant"]);
  other.causes.front().parameters = LagNumbers({of["delay"], of["time_constant"]});
  other.effect.finding.u.clear();
  const AskedAgain asked = fit_->Ask(causes);
  if (IsClearlyLess(fit_->PowerOf(asked.left), asked.left)) Accept(asked, std::move(causes), kFewCauses);
}

/// All at once, if the first of them is held and they leave no more than half.
void LargeSearch::TakeBlock(std::vector<LargeCause> block) {
  const std::string leader = block.front().effect.name;
  FittedCauses all = fit_->Fit(std::move(block));
  if (all.causes.empty() || all.causes.front().effect.name != leader || !(all.power < 0.5 * power_)) return;
  for (std::size_t k = 0; k < all.causes.size(); ++k)
    all.causes[k].explained = fit_->PowerWithout(k, all.asked) - all.power;
  Accept(all.asked, std::move(all.causes), kFewCauses);
}

void LargeSearch::TakeLarge() {
  while (large_.causes.size() < kMostLarge && TakeNext()) {
  }
}

/// @return false if nothing more is large, or the twin does not show it as the search has it.
bool LargeSearch::TakeNext() {
  const std::optional<LargeCause> next = LargestNamed(large_.Last());
  if (next && Take(*next)) return true;
  if (TakeOneOfTwoWaves()) return true;
  const Searched& last = large_.Last();
  std::vector<Cause> like;
  for (const int k : NamedLikeUnnamed(last)) {
    like.push_back(CauseFrom(last.families[static_cast<std::size_t>(k)], last.analysis.found.alone.grid_point(k, 0),
                             last.encoder.run.residual, fit_->Run().run.sigma, fit_->projector()));
  }
  for (Cause& cause : like) cause.probability /= static_cast<double>(like.size());
  return !like.empty() && Take(LedBy(std::move(like), 0, last.encoder.run.bench));
}

bool LargeSearch::TakeOneOfTwoWaves() {
  const std::optional<LargeCause> one = OneOfTwoWaves(large_.Last(), OrdersApart(large_.first->encoder.context));
  return one && Take(*one);
}

bool LargeSearch::Take(const LargeCause& next) {
  std::vector<LargeCause> causes = large_.causes;
  const double apart = OrdersApart(large_.first->encoder.context);
  const auto same = std::ranges::find_if(causes, [&](const LargeCause& cause) { return AreOneWave(cause, next, apart); });
  if (same != causes.end()) return TakeSum(static_cast<std::size_t>(same - causes.begin()), next);
  causes.push_back(next);
  // Of a cause whose size is not known there is nothing to be asked.
  if (MovableOf({next}).empty()) return false;
  const AskedAgain asked = fit_->Ask(causes);
  const double power = fit_->PowerOf(asked.left);
  constexpr double kNeedless = 0.5;  // of what would be dropped in the end
  if (power_ - power < kNeedless * LeastExplained() || IsOtherFunctionOfSpeed(next, asked)) return false;
  if (!(power < power_) || !IsHeld(asked.effects.back())) return false;
  const EffectSettings& taken = asked.effects.back();
  for (const char* size : {"width", "lag"}) {
    const auto of = taken.parameters.find(size);
    if (of != taken.parameters.end() && LeadsBesideLatency(taken.name, of->second, large_.causes)) return false;
  }
  if (WouldBeDropped(asked, causes)) return false;
  causes.back().explained = power_ - power;
  Accept(asked, std::move(causes), kFewCauses);
  return true;
}

/// The last of these, beside all else that is there: known when that has been searched for.
bool LargeSearch::WouldBeDropped(const AskedAgain& asked, std::vector<LargeCause> causes) const {
  if (most_searched_ != kMostCauses) return false;
  TakeOver(asked, causes);
  return Strengths(causes, LeftByTerms(&causes.back().causes.front())).back() <= tuning::kHeadline;
}

/// What is taken for a latency and goes with another function of the speed: that explains more alone, however the latency bends,
/// and beside it the latency explains hardly anything.
bool LargeSearch::IsOtherFunctionOfSpeed(const LargeCause& next, const AskedAgain& asked) const {
  constexpr double kSame = 0.995, kHardly = 0.01;  // of what that explains; of what the latency does
  if (next.effect.name != "latency") return false;
  const Searched& last = large_.Last();
  const Evidence& alone = last.analysis.found.alone;
  double named = 0.0, most = 0.0;
  Eigen::MatrixXd other;
  for (int k = 0; k < std::ssize(last.families); ++k) {
    const Family& family = last.families[static_cast<std::size_t>(k)];
    if (IsOf(next.causes.front(), family)) named = alone.explained(k, 0);
    if (family.effect != "speed" || alone.explained(k, 0) <= most) continue;
    most = alone.explained(k, 0);
    other = family.ColumnsAt(alone.grid_point(k, 0));
  }
  if (std::max(named, power_ - fit_->PowerOf(asked.left)) > kSame * most) return false;
  const Eigen::VectorXd left = fit_->WhiteOf(last.encoder.run.residual);
  const auto explained = [&](const Eigen::MatrixXd& columns) {
    Eigen::MatrixXd white(left.size(), columns.cols());
    for (Eigen::Index k = 0; k < columns.cols(); ++k) white.col(k) = fit_->WhiteOf(columns.col(k));
    return (white * SolveShortest(white, left)).squaredNorm();
  };
  Eigen::MatrixXd both(other.rows(), other.cols() + asked.slopes.cols());
  both << other, asked.slopes;
  return explained(both) - explained(other) < kHardly * named;
}

/// Beside the memory of what is left: Kass and Raftery, Bayes factors (1995). Over a part of a turn the next lower order always
/// takes a little more of what is no wave, and grows against a scale.
bool LargeSearch::IsClearlyLess(double power, const Eigen::VectorXd& left) const {
  constexpr double kStrongly = 6.0;
  const double readings = static_cast<double>(left.size()) / fit_->Memory(left);
  return readings * std::log(power_ / power) > kStrongly;
}

/// A second wave of the k-th one's order, or of one that is not told from it, is what that lacks: it was fitted before all
/// was there.
/// @return false if no order about both explains it.
bool LargeSearch::TakeSum(std::size_t k, const LargeCause& more) {
  constexpr double kMostOrdersTried = 16.0;
  const double middle_rad = large_.first->encoder.context.device_rad.mean();
  const auto [first, last] = std::minmax(*WaveOrderOf(large_.causes[k].effect), *WaveOrderOf(more.effect));
  const double about = first < last ? 1.0 : 0.0, step = std::max(1.0, std::ceil((last - first) / kMostOrdersTried));
  std::vector<LargeCause> best;
  AskedAgain of_best;
  for (double order = first - about; order <= last + about; order += step) {
    std::vector<LargeCause> causes = large_.causes;
    causes[k] = SumOfWaves(causes[k], more, order, middle_rad);
    const AskedAgain asked = fit_->Ask(causes);
    if (!best.empty() && !(asked.power < of_best.power)) continue;
    best = std::move(causes);
    of_best = asked;
  }
  const double power = fit_->PowerOf(of_best.left);
  if (!(power < power_ - kBetter)) return false;
  const bool is_moved = *WaveOrderOf(best[k].effect) != *WaveOrderOf(large_.causes[k].effect);
  if (is_moved && LeastOrder(large_.first->encoder.context) > 1 && !IsClearlyLess(power, of_best.left)) return false;
  best[k].explained += power_ - power;
  Accept(of_best, std::move(best), kFewCauses);
  return true;
}

}  // namespace twinbench::diagnose::encoder
