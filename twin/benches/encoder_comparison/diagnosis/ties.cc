#include "twin/benches/encoder_comparison/diagnosis/ties.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Of a lag against a loop: how a shaft turned between two readings is not known.
constexpr double kAsExactWhereItTurns = 1e-3;

/// In a motion of one speed a delay is what play or hysteresis is, but where it turns.
bool IsLagOrLoop(const std::string& effect) { return effect == "latency" || IsLoop(effect); }

/// A cause with the size and shape with which it explains most of rows, alone; nothing if there is no such family.
std::optional<Cause> Alone(const TwinFit& fit, const Cause& cause, const Eigen::VectorXd& rows) {
  const Eigen::VectorXd& sigma = fit.Run().run.sigma;
  std::optional<Cause> most;
  for (const Family& family : fit.Families()) {
    if (family.kind != Kind::kNamed || !IsOf(cause, family)) continue;
    const int points = IsLagOrLoop(family.effect) ? family.grid : 1;
    for (int point = 0; point < points; ++point) {
      Cause at = CauseFrom(family, point, rows, sigma, fit.projector());
      if (!most || at.rho > most->rho) most = std::move(at);
    }
    if (!IsLagOrLoop(family.effect)) break;
  }
  return most;
}

/// Puts the j-th member of the k-th tie into the twin instead of the first, with the size that the others leave it.
/// @return false if it cannot be asked about.
bool LetLead(const TwinFit& fit, std::size_t k, std::size_t j, const AskedAgain& asked,
             std::vector<LargeCause>& causes) {
  const LinearRun& plain = fit.Run().run;
  const std::optional<Cause> alone =
      Alone(fit, causes[k].causes[j], plain.residual - fit.Shown(EffectsWithout(k, asked.effects)));
  if (!alone) return false;
  const double explained = causes[k].explained;
  causes[k].causes[j].parameters = alone->parameters;
  causes[k].causes.front().parameters.clear();  // it is not what is fitted
  causes[k] = LedBy(causes[k].causes, j, plain.bench);
  causes[k].explained = explained;
  for (std::size_t i = 0; i < causes.size(); ++i) {
    if (i != k) causes[i].effect = asked.effects[i];
  }
  return !MovableOf({causes[k]}).empty();
}

/// With the j-th member of the k-th tie in the twin.
std::optional<FittedCauses> LedByOther(const TwinFit& fit, std::size_t k, std::size_t j, const FittedCauses& now) {
  std::vector<LargeCause> causes = now.causes;
  if (!LetLead(fit, k, j, now.asked, causes)) return {};
  return fit.Fit(std::move(causes));
}

/// Sine and cosine that err are not exactly waves, and a wave is; whoever has one such fault has others, which take away
/// what it is more than a wave.
bool DifferInSecondOrder(const TwinFit& fit, const FittedCauses& wave, const FittedCauses& signals, std::size_t k) {
  constexpr std::array kWaves = {"eccentricity", "ellipticity"};
  if (std::ranges::count(kWaves, wave.causes[k].effect.name) == 0) return false;
  const SecondOrder bent(EffectsOf(wave.causes), fit.Run());
  return bent.MayBe(fit.Shown(signals.asked.effects) - fit.Shown(wave.asked.effects));
}

/// A gap is crossed over its width, or more with a soft end; what goes over sooner, and not at once, is a lag of a motion of one speed.
bool IsCrossedTooSoon(const FittedCauses& fitted, std::size_t k) {
  constexpr double kSoon = 0.75;
  if (k >= fitted.causes.size() || fitted.causes[k].effect.name != "backlash") return false;
  const std::map<std::string, double>& gap = fitted.causes[k].effect.parameters;
  return gap.at("crossed_over") > 0.0 && gap.at("crossed_over") < kSoon * std::abs(gap.at("width"));
}

/// By how much the power of what is left exceeds that of white noise that says as much.
double NoiseOf(const TwinFit& fit, double power, double memory) {
  return memory * std::max(1.0, power / fit.projector().DegreesOfFreedom());
}

/// @param ties  By cause, the members that explain as much as the one that leads it now.
/// @return the first that is clearly better led by another one.
std::optional<FittedCauses> BetterLed(const TwinFit& fit, const FittedCauses& now,
                                      std::vector<std::vector<Cause>>& ties) {
  ties.clear();
  const double memory = fit.Memory(now.asked.left);
  for (std::size_t k = 0; k < now.causes.size(); ++k) {
    ties.push_back({now.causes[k].causes.front()});
    for (std::size_t j = 1; j < now.causes[k].causes.size(); ++j) {
      std::optional<FittedCauses> other = LedByOther(fit, k, j, now);
      if (!other) continue;
      const double of_rest = NoiseOf(fit, std::min(other->power, now.power), memory);
      const bool is_lag_or_loop = (now.causes[k].effect.name == "latency") != (now.causes[k].causes[j].effect == "latency");
      const double as_exact = is_lag_or_loop ? kAsExactWhereItTurns : kAsExact;
      const double noise = std::max(of_rest, as_exact * now.causes[k].explained / kBetter);
      const double more = other->Costs(noise) - now.Costs(noise);
      if (more < -0.5 * kBetter) return other;
      // A loop that was added beside a loop (AddLagsAndLoops) leads where it is better, and ties with none: the search knew both.
      const bool is_added = now.causes[k].causes[j].probability == 0.0;
      if (is_added && IsLoop(now.causes[k].effect.name) && IsLoop(now.causes[k].causes[j].effect)) continue;
      if (IsCrossedTooSoon(*other, k)) continue;
      if (more <= kBetter || DifferInSecondOrder(fit, now, *other, k)) ties.back().push_back(now.causes[k].causes[j]);
    }
  }
  return {};
}

/// What each may be as well, where what is left is no noise of the readings: another cause without a shape of its own that
/// explains nearly as much in its place.
/// @param explained  By the k-th cause.
std::vector<Cause> RivalsOf(const TwinFit& fit, const FittedCauses& now, std::size_t k, double explained, double noise) {
  constexpr double kNearly = 0.8, kLikelier = 6.0;  // of what it explains; Kass and Raftery, Bayes factors (1995)
  const LinearRun& plain = fit.Run().run;
  const Eigen::VectorXd left = plain.residual - fit.Shown(EffectsWithout(k, now.asked.effects));
  std::vector<Cause> rivals;
  for (const Family& family : fit.Families()) {
    const auto has = [&](const LargeCause& cause) {
      return std::ranges::any_of(cause.causes, [&](const Cause& c) { return IsOf(c, family); });
    };
    if (family.kind != Kind::kNamed || !family.shapes.empty() || std::ranges::any_of(now.causes, has)) continue;
    Cause rival = CauseFrom(family, 0, left, plain.sigma, fit.projector());
    const double by_rival = rival.rho * rival.rho;
    if (by_rival < std::max(kNearly * explained, explained - kLikelier * noise)) continue;
    rival.probability = std::exp(0.5 * std::min(0.0, by_rival - explained) / noise);
    rivals.push_back(std::move(rival));
  }
  return rivals;
}

/// @param now  Gets more members in its ties, which share the probability of what ties already.
void AddRivals(const TwinFit& fit, double noise, FittedCauses& now) {
  for (std::size_t k = 0; k < now.causes.size(); ++k) {
    const double explained = fit.PowerWithout(k, now.asked) - now.power;
    std::vector<Cause> rivals = RivalsOf(fit, now, k, explained, noise);
    double all = 1.0;
    for (const Cause& rival : rivals) all += rival.probability;
    std::vector<Cause>& members = now.causes[k].causes;
    const double together = members.front().probability;
    for (Cause& cause : members) cause.probability /= all;
    for (Cause& rival : rivals) {
      rival.probability *= together / all;
      members.front().indistinguishable_from.push_back({rival.effect, rival.where, std::min(1.0, rival.rho * rival.rho / explained)});
      members.push_back(std::move(rival));
    }
  }
}

/// @param now  Gets as members of each lag or loop the others that explain nearly as much in its place.
void AddLagsAndLoops(const TwinFit& fit, FittedCauses& now) {
  constexpr double kNearly = 0.9;  // of what it explains
  if (!fit.Run().context.Moves()) return;
  for (std::size_t k = 0; k < now.causes.size(); ++k) {
    if (!IsLagOrLoop(now.causes[k].effect.name)) continue;
    const Eigen::VectorXd left = fit.Run().run.residual - fit.Shown(EffectsWithout(k, now.asked.effects));
    const double explained = fit.PowerOf(left) - now.power;
    for (const char* effect : {"latency", "backlash", "hysteresis"}) {
      const auto has = [&](const LargeCause& cause) {
        return cause.effect.name == effect || std::ranges::any_of(cause.causes, [&](const Cause& c) { return c.effect == effect; });
      };
      if (std::ranges::any_of(now.causes, has)) continue;
      Cause named;
      named.effect = effect;
      std::optional<Cause> other = Alone(fit, named, left);
      if (!other || other->rho * other->rho < kNearly * explained) continue;
      other->probability = 0.0;  // shared out among those that stay
      now.causes[k].causes.push_back(*std::move(other));
    }
  }
}

double SumOf(const std::vector<Cause>& members) {
  double sum = 0.0;
  for (const Cause& cause : members) sum += cause.probability;
  return sum;
}

/// What has none yet is as probable as the most probable.
void ShareOut(double all, std::vector<Cause>& members) {
  const double most = std::ranges::max(members, {}, &Cause::probability).probability;
  for (Cause& cause : members)
    if (cause.probability == 0.0) cause.probability = most > 0.0 ? most : 1.0;
  const double sum = SumOf(members);
  for (Cause& cause : members) cause.probability *= all / sum;
}

}  // namespace

bool SettleTies(const TwinFit& fit, FittedCauses& now) {
  constexpr int kMostRounds = 16;  // noise is judged anew each time: two might be better than each other
  std::vector<std::vector<Cause>> ties;
  bool is_changed = false;
  constexpr double kNoNoise = 20.0;  // below, what is left says what is what
  const double noise = NoiseOf(fit, now.power, fit.Memory(now.asked.left));
  noise < kNoNoise ? AddLagsAndLoops(fit, now) : AddRivals(fit, noise, now);
  std::optional<FittedCauses> better = BetterLed(fit, now, ties);
  for (int round = 0; better && round < kMostRounds; ++round) {
    now = *std::move(better);
    is_changed = true;
    better = BetterLed(fit, now, ties);
  }
  for (std::size_t k = 0; k < now.causes.size(); ++k) {
    if (now.causes[k].causes.size() > 1) ShareOut(ties[k].size() == 1 ? tuning::kListed : SumOf(now.causes[k].causes), ties[k]);
    now.causes[k].causes = std::move(ties[k]);
  }
  return is_changed;
}

}  // namespace twinbench::diagnose::encoder
