#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/benches/encoder_comparison/diagnosis/part_of_readings.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_block.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_guess.h"
#include "twin/benches/encoder_comparison/diagnosis/stop_errors.h"
#include "twin/benches/encoder_comparison/diagnosis/ties.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr std::size_t kMostLarge = 16;
/// An angle device may well have an error of many orders. As long as something large is found, the first few are
/// enough: what a large cause leaves to first order is explained by shapes that are gone once the twin has it.
constexpr int kMostCauses = 8, kFewCauses = 3;
/// A device whose signals err says where they begin.
void TellSignalZero(const std::vector<EffectSettings>& effects, DeviceSettings& device) {
  for (const EffectSettings& effect : effects) {
    const auto zero = effect.parameters.find("zero");
    if (zero == effect.parameters.end() || device.signal_zero_known) continue;
    device.signal_zero_rad += zero->second;
    device.signal_zero_known = true;
  }
}

/// The parameters of what is in the twin stay free: rows x (what was free, slopes).
void LeaveFree(const AskedAgain& asked, Nuisance& nuisance) {
  const Eigen::Index had = nuisance.jacobian.cols(), count = asked.slopes.cols();
  Eigen::MatrixXd all(nuisance.jacobian.rows(), had + count);
  all << nuisance.jacobian.toDense(), asked.slopes;
  nuisance.jacobian = all.sparseView();
  nuisance.prior_precision.conservativeResize(had + count);
  nuisance.prior_precision.tail(count) = asked.sd.cwiseAbs2().cwiseInverse();
}

/// Errors of targets may be anything.
void LeaveFree(const Eigen::MatrixXd& targets, EncoderRun& encoder) {
  encoder.targets = targets;
  Nuisance& nuisance = encoder.run.nuisance;
  const double precision = nuisance.prior_precision[0];
  AskedAgain any;
  any.slopes = targets;
  any.sd = Eigen::VectorXd::Constant(targets.cols(), 1.0 / std::sqrt(precision));
  if (targets.cols() > 0) LeaveFree(any, nuisance);
}

class Search {
 public:
  /// @param targets  Whose errors are free; may be none.
  Search(const std::vector<Reading>& readings, const Scenario& scenario, const DiagnoseOptions& options,
         const model::FollowMaker& follow, const Eigen::MatrixXd& targets)
      : readings_(readings),
        scenario_(scenario),
        options_(options),
        follow_(follow),
        how_(AnalysisOptionsOf(options)) {
    large_.targets = targets;
  }

  /// @param known      Large causes that a part of the readings has shown.
  /// @param most_left  Power that the large causes may leave, or the rest is not looked into.
  std::optional<LargeCauses> Go(std::vector<LargeCause> known,
                                double most_left = std::numeric_limits<double>::infinity()) {
    Begin(known.empty() ? kFewCauses : 0);
    if (!TakeKnown(std::move(known))) TakeSignals();
    TakeLarge();
    if (power_ - kFewCauses * kLarge * kLarge > most_left) return std::nullopt;  // what is not large has yet to be taken
    while (SearchOn()) TakeLarge();
    LeaveToLarge();
    DropNeedless();
    EndTies();
    MoveBesideTheRest();
    JudgeUnsure();
    TellWhatEachShows();
    TellWhatNamesLeave();
    return std::move(large_);
  }

  /// The large causes alone, to begin with; what they leave is not looked into.
  std::vector<LargeCause> Look() {
    null_ = NullCalibration{std::vector<double>(10, 0.0)};  // what is large is far above any threshold
    how_.null = &null_;
    Begin(kFewCauses);
    TakeSignals();
    TakeLarge();
    return large_.causes;
  }

 private:
  AnalysisOptions For(int most_causes) const {
    AnalysisOptions how = how_;
    how.most_causes = most_causes;
    how.largest_only = most_causes < kMostCauses;
    return how;
  }

  void Begin(int most_causes) {
    EncoderRun begin = BuildRun(readings_, scenario_, follow_);
    LeaveFree(large_.targets, begin);
    large_.first = SearchIn(std::move(begin), options_.excluded, For(most_causes));
    most_searched_ = most_causes;
    null_ = large_.first->analysis.null;
    how_.null = &null_;
    fit_.emplace(large_, scenario_, follow_);
    power_ = fit_->PowerOf(fit_->Run().run.residual);
  }

  /// Where something began is not known of readings that were left out: onsets are looked for among all.
  /// @return false if there was none.
  bool TakeKnown(std::vector<LargeCause> known) {
    std::erase_if(known, [](const LargeCause& cause) { return cause.effect.name == "slip"; });
    if (known.empty()) return false;
    const AskedAgain asked = fit_->Ask(known);
    if (!(fit_->PowerOf(asked.left) < power_)) return false;
    double power = power_;
    for (std::size_t k = 0; k < known.size(); ++k) {
      const std::vector<EffectSettings> first(asked.effects.begin(), asked.effects.begin() + std::ptrdiff_t(k) + 1);
      const double left = fit_->PowerOf(large_.first->encoder.run.residual - fit_->Shown(first));
      known[k].explained = std::max(0.0, power - left);
      power = left;
    }
    Accept(asked, std::move(known), kFewCauses);
    return true;
  }

  /// Signals that are cut off have all their faults at once: none of them is found alone.
  void TakeSignals() {
    const EncoderRun& encoder = large_.first->encoder;
    if (power_ < kLarge * kLarge || std::ranges::count(options_.excluded, "signal_clipping") > 0) return;
    const std::optional<SignalGuess> guess = GuessSignals(encoder.context, encoder.run.residual);
    if (!guess) return;
    FittedCauses all = fit_->Fit(SignalBlock(*guess, encoder, options_.excluded));
    if (all.causes.empty() || all.causes.front().effect.name != "signal_clipping" || !(all.power < 0.5 * power_)) return;
    for (std::size_t k = 0; k < all.causes.size(); ++k)
      all.causes[k].explained = fit_->PowerWithout(k, all.asked) - all.power;
    Accept(all.asked, std::move(all.causes), kFewCauses);
  }

  void TakeLarge() {
    while (large_.causes.size() < kMostLarge && TakeNext()) {
    }
  }

  /// For all that is left, where the last search ended at the first.
  /// @return false if there was no need.
  bool SearchOn() {
    std::unique_ptr<Searched>& last = large_.last ? large_.last : large_.first;
    if (most_searched_ == kMostCauses || last->analysis.found.terms.empty()) return false;
    last->analysis.scanner.reset();
    last = SearchIn(std::move(last->encoder), Excluded(large_.causes), For(kMostCauses));
    most_searched_ = kMostCauses;
    return true;
  }

  std::vector<std::string> Excluded(const std::vector<LargeCause>& causes) const {
    std::vector<std::string> excluded = ThatAreOnce(causes, EncoderOf(scenario_).device.signal_periods);
    // A name that is given away leaves its orders to no shape without one.
    if (!excluded.empty() && !IsExcluded(options_, "periodic")) excluded.push_back("harmonic");
    excluded.insert(excluded.end(), options_.excluded.begin(), options_.excluded.end());
    return excluded;
  }

  void Accept(const AskedAgain& asked, std::vector<LargeCause> causes, int most_causes) {
    // Its signatures were for the search alone, and the next one has its own.
    (large_.last ? large_.last : large_.first)->analysis.scanner.reset();
    auto searched = SearchWith(asked, causes, For(most_causes));
    most_searched_ = most_causes;
    TakeOver(asked, causes);
    power_ = fit_->PowerOf(asked.left);
    large_.causes = std::move(causes);
    large_.last = std::move(searched);
  }

  /// @return false if nothing more is large, or the twin does not show it as the search has it.
  bool TakeNext() {
    const std::optional<LargeCause> next = LargestNamed(large_.Last());
    if (next && Take(*next)) return true;
    const Searched& last = large_.Last();
    std::vector<Cause> like;
    for (const int k : NamedLikeUnnamed(last)) {
      like.push_back(CauseFrom(last.families[static_cast<std::size_t>(k)], last.analysis.found.alone.grid_point(k, 0),
                               last.encoder.run.residual, fit_->Run().run.sigma, fit_->projector()));
    }
    for (Cause& cause : like) cause.probability /= static_cast<double>(like.size());
    return !like.empty() && Take(LedBy(std::move(like), 0, last.encoder.run.bench));
  }

  bool Take(const LargeCause& next) {
    std::vector<LargeCause> causes = large_.causes;
    const auto same = std::ranges::find_if(causes, [&](const LargeCause& cause) { return IsOneWave(cause, next); });
    if (same != causes.end()) return TakeSum(static_cast<std::size_t>(same - causes.begin()), next);
    causes.push_back(next);
    // Of a cause whose size is not known there is nothing to be asked.
    if (MovableOf({next}).empty()) return false;
    AskedAgain asked = fit_->Ask(causes);
    double power = fit_->PowerOf(asked.left);
    if (!(power < power_) || !IsHeld(asked.effects.back())) return false;
    causes.back().explained = power_ - power;
    Accept(asked, std::move(causes), kFewCauses);
    return true;
  }

  static bool IsOneWave(const LargeCause& a, const LargeCause& b) {
    return a.effect.name == b.effect.name && a.effect.where == b.effect.where && WaveOrderOf(a.effect) &&
           WaveOrderOf(a.effect) == WaveOrderOf(b.effect) && a.effect.parameters.contains("phase");
  }

  /// A second wave of the k-th one's order is what that lacks: it was fitted before all was there.
  /// @return false if that does not explain it.
  bool TakeSum(std::size_t k, const LargeCause& more) {
    std::vector<LargeCause> causes = large_.causes;
    std::map<std::string, double>& wave = causes[k].effect.parameters;
    const std::complex<double> sum =
        std::polar(wave.at("amplitude"), wave.at("phase")) +
        std::polar(more.effect.parameters.at("amplitude"), more.effect.parameters.at("phase"));
    wave["amplitude"] = std::abs(sum);
    wave["phase"] = std::arg(sum);
    const AskedAgain asked = fit_->Ask(causes);
    const double power = fit_->PowerOf(asked.left);
    if (!(power < power_ - kBetter)) return false;
    causes[k].explained += power_ - power;
    Accept(asked, std::move(causes), kFewCauses);
    return true;
  }

  void EndTies() {
    if (large_.causes.empty()) return;
    FittedCauses now = fit_->Fit(large_.causes);
    if (SettleTies(*fit_, now)) {
      Accept(now.asked, std::move(now.causes), kMostCauses);
    } else {
      large_.causes = std::move(now.causes);
    }
  }

  /// A wave of an order that a large cause has is what that lacks beside the others that the last search found; what is
  /// less than a device is as exact as its formula is no cause, nor is what the memory of the rest makes by chance.
  void LeaveToLarge() {
    if (!large_.last || large_.last->analysis.found.terms.empty()) return;
    const double least = LeastExplained();
    const Eigen::VectorXd left = Left();
    const auto is_of_large = [this](const Term& term) {
      const Family& family = large_.last->families[static_cast<std::size_t>(term.family)];
      return std::ranges::any_of(large_.causes, [&](const LargeCause& cause) {
        return cause.effect.name == family.effect && term.shape.size() == 1 && WaveOrderOf(cause.effect) == term.shape[0];
      });
    };
    std::erase_if(large_.last->analysis.found.terms, [&](const Term& term) {
      return term.explained < least || is_of_large(term) || IsChance(term, left);
    });
  }

  /// What all large causes explain together is exact to this.
  double LeastExplained() const {
    double explained = 0.0;
    for (const LargeCause& cause : large_.causes) explained += cause.explained;
    return kAsExact * explained;
  }

  /// What neither the large causes nor the others explain, whitened.
  Eigen::VectorXd Left() const {
    return large_.causes.empty() ? fit_->WhiteOf(Beside()) : fit_->WhiteOf(fit_->Ask(large_.causes, Beside()).left);
  }

  bool IsChance(const Term& term, const Eigen::VectorXd& left) const {
    const Eigen::VectorXd own = fit_->WhiteOf(term.columns * term.amplitudes);
    const double noise = left.squaredNorm() / static_cast<double>(left.size());
    return own.squaredNorm() < std::pow(tuning::kHeadline, 2) * noise * MemoryAlong(own, left);
  }

  /// What stood for something that was found later is not kept, nor what the memory of the rest makes by chance: the
  /// weakest first, for what it kept from being found may be what made others look weak.
  void DropNeedless() {
    while (!large_.causes.empty()) {
      const std::vector<double> strength = Strengths();
      const auto weakest = std::ranges::min_element(strength);
      if (*weakest > tuning::kHeadline) return;
      std::vector<LargeCause> kept = large_.causes;
      kept.erase(kept.begin() + (weakest - strength.begin()));
      if (kept.empty()) return SearchPlain();
      const AskedAgain asked = fit_->Ask(kept);
      Accept(asked, std::move(kept), kMostCauses);
      LeaveToLarge();
    }
  }

  /// Of each large cause, how many of its uncertainties it is away from nothing, with the memory of the rest; 0 of what
  /// is less than the others are as exact as their formula.
  std::vector<double> Strengths() const {
    const AskedAgain beside = fit_->Ask(large_.causes, Beside());
    const Eigen::VectorXd left = fit_->WhiteOf(beside.left);
    const double memory = fit_->Memory(beside.left), least = LeastExplained();
    std::vector<double> strengths;
    for (std::size_t k = 0; k < large_.causes.size(); ++k) {
      const Eigen::VectorXd own =
          fit_->WhiteOf(fit_->Shown(beside.effects) - fit_->Shown(EffectsWithout(k, beside.effects)));
      const double most = std::max(memory, MemoryAlong(own, left));
      strengths.push_back(own.squaredNorm() > least ? Deviations(large_.causes[k].effect) / std::sqrt(most) : 0.0);
    }
    return strengths;
  }

  /// Nothing of it was there: for all at once, as if nothing had been large.
  void SearchPlain() {
    large_.causes.clear();
    large_.last.reset();
    most_searched_ = kFewCauses;
    SearchOn();
  }

  /// What was taken while others were missing may have looked like a shape without a name: it is judged anew beside all
  /// of them.
  void JudgeUnsure() {
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
  std::vector<Cause> InPlaceOf(std::size_t k) const {
    const std::vector<EffectSettings> others = EffectsWithout(k, EffectsOf(large_.causes));
    EncoderRun encoder = BuildRun(readings_, fit_->With(others), follow_);
    encoder.run.sigma = large_.Last().encoder.run.sigma;
    for (const Term& term : large_.Last().analysis.found.terms) encoder.run.residual -= term.columns * term.amplitudes;
    LeaveFree(large_.targets, encoder);
    AnalysisOptions how = For(1);
    how.largest_only = false;  // which would leave the place to a name
    const auto searched = SearchIn(std::move(encoder), options_.excluded, how);
    if (searched->analysis.found.terms.empty()) return {};
    return AnswerOf(searched->analysis.found, 0, searched->families).causes;
  }

  std::unique_ptr<Searched> SearchWith(const AskedAgain& asked, const std::vector<LargeCause>& causes,
                                       const AnalysisOptions& how) const {
    EncoderRun encoder = BuildRun(readings_, fit_->With(asked.effects), follow_);
    LeaveFree(large_.targets, encoder);
    LeaveFree(asked, encoder.run.nuisance);
    TellSignalZero(asked.effects, encoder.context.device);
    return SearchIn(std::move(encoder), Excluded(causes), how);
  }

  /// What is small was found with the parameters of the large causes free: these go to where they are best beside
  /// it.
  void MoveBesideTheRest() {
    if (large_.causes.empty()) return;
    AskedAgain asked = fit_->Ask(large_.causes, Beside());
    const double more = std::sqrt(fit_->Memory(asked.left));
    for (EffectSettings& effect : asked.effects) {
      for (auto& [parameter, u] : effect.finding.u) u *= more;
    }
    TakeOver(asked, large_.causes);
  }

  /// What is left for the large causes once the last search has explained the rest.
  Eigen::VectorXd Beside() const {
    Eigen::VectorXd rows = large_.first->encoder.run.residual;
    for (const Term& term : large_.Last().analysis.found.terms) rows -= term.columns * term.amplitudes;
    return rows;
  }

  void TellWhatEachShows() {
    std::vector<EffectSettings> effects;
    Eigen::VectorXd before = Eigen::VectorXd::Zero(fit_->Run().run.Rows());
    for (LargeCause& cause : large_.causes) {
      effects.push_back(cause.effect);
      const Eigen::VectorXd shown = fit_->Shown(effects);
      cause.shown = shown - before;
      before = shown;
    }
  }

  void TellWhatNamesLeave() {
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

  const std::vector<Reading>& readings_;
  const Scenario& scenario_;
  const DiagnoseOptions& options_;
  const model::FollowMaker& follow_;
  AnalysisOptions how_;
  NullCalibration null_;
  LargeCauses large_;
  int most_searched_ = kFewCauses;  // causes that the last search might take
  std::optional<TwinFit> fit_;
  double power_ = 0.0;
};

/// What stays behind on a reversal, with a course of its own behind it.
constexpr std::array kLoops = {"backlash", "hysteresis"};

/// Large or not.
bool HasLoop(const LargeCauses& large) {
  const auto is_loop = [](const std::string& effect) { return std::ranges::count(kLoops, effect) > 0; };
  const Searched& last = large.Last();
  return std::ranges::any_of(large.causes, [&](const LargeCause& cause) { return is_loop(cause.effect.name); }) ||
         std::ranges::any_of(last.analysis.found.terms, [&](const Term& term) {
           return is_loop(last.families[static_cast<std::size_t>(term.family)].effect);
         });
}

/// Free numbers of all that has a name.
double NamedNumbers(const LargeCauses& large) {
  std::size_t numbers = MovableOf(large.causes).size();
  const Searched& last = large.Last();
  for (const Term& term : last.analysis.found.terms) {
    if (last.families[static_cast<std::size_t>(term.family)].kind != Kind::kNamed) continue;
    numbers += static_cast<std::size_t>(term.shape.size() + term.amplitudes.size());
  }
  return static_cast<double>(numbers);
}

/// Schwarz's criterion, in the noise that the better of the two leaves.
bool IsBetterNamed(const LargeCauses& a, const LargeCauses& b) {
  constexpr double kStrongly = 6.0;  // Kass and Raftery, Bayes factors (1995)
  const auto readings = static_cast<double>(a.first->encoder.run.Rows());
  const LargeCauses& better = a.named_left < b.named_left ? a : b;
  const double noise = better.memory * std::max(1.0, better.named_left / readings);
  const double more = (a.named_left - b.named_left) / noise + std::log(readings) * (NamedNumbers(a) - NamedNumbers(b));
  return more < -kStrongly;
}

/// On the move a loop may stand for several causes at once that are plain: for a lag and a scale, say.
LargeCauses OrWithoutLoops(LargeCauses found, const std::vector<Reading>& readings, const Scenario& scenario,
                           DiagnoseOptions options, const model::FollowMaker& follow) {
  constexpr double kNearly = 1.02;
  if (!HasLoop(found) || !found.first->encoder.context.Moves()) return found;
  options.excluded.insert(options.excluded.end(), kLoops.begin(), kLoops.end());
  options.excluded.emplace_back("slip");  // an onset is no plainer than a reversal
  std::optional<LargeCauses> plain = Search(readings, scenario, options, follow, {}).Go({}, kNearly * found.left);
  return plain && IsBetterNamed(*plain, found) ? *std::move(plain) : std::move(found);
}

}  // namespace

LargeCauses FindLargeCauses(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const model::FollowMaker& follow) {
  const std::vector<Reading> part = PartOf(readings);
  std::vector<LargeCause> known;
  if (part.size() < readings.size()) known = Search(part, scenario, options, follow, {}).Look();
  LargeCauses plain = OrWithoutLoops(*Search(readings, scenario, options, follow, {}).Go(known), readings, scenario,
                                     options, follow);
  const Eigen::MatrixXd targets = Targets(plain.first->encoder.context);
  if (targets.size() == 0 || !LeaveErrorsOfTargets(plain, targets)) return plain;
  return *Search(readings, scenario, options, follow, targets).Go(known);
}

}  // namespace twinbench::diagnose::encoder
