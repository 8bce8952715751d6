#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

#include <algorithm>
#include <complex>
#include <map>
#include <optional>
#include <string>

#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/benches/encoder_comparison/diagnosis/part_of_readings.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_block.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_guess.h"
#include "twin/benches/encoder_comparison/diagnosis/stop_errors.h"
#include "twin/benches/encoder_comparison/format.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr std::size_t kMostLarge = 16;
/// An angle device may well have an error of many orders. As long as something large is found, the first few are
/// enough: what a large cause leaves to first order is explained by shapes that are gone once the twin has it.
constexpr int kMostCauses = 8, kFewCauses = 3;
/// What a cause has to explain beside the others, in units of noise: no chance.
constexpr double kBetter = 25.0;
/// Share of what a cause explains to which no device is as its formula: less does not tell one cause from another.
constexpr double kAsExact = 1e-4;

Scenario With(Scenario scenario, const std::vector<EffectSettings>& effects) {
  scenario.effects.insert(scenario.effects.end(), effects.begin(), effects.end());
  return scenario;
}

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

  /// @param known  Large causes that a part of the readings has shown.
  LargeCauses Go(std::vector<LargeCause> known) {
    Begin(known.empty() ? kFewCauses : 0);
    if (!TakeKnown(std::move(known))) TakeSignals();
    TakeAll();
    LeaveToLarge();
    DropNeedless();
    EndTies();
    MoveBesideTheRest();
    JudgeUnsure();
    TellWhatEachShows();
    return std::move(large_);
  }

  /// The large causes alone, to begin with; what they leave is not looked into.
  std::vector<LargeCause> Look() {
    null_ = NullCalibration{std::vector<double>(10, 0.0)};  // what is large is far above any threshold
    how_.null = &null_;
    Begin(kFewCauses);
    TakeSignals();
    while (large_.causes.size() < kMostLarge && TakeNext()) {
    }
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
    const LinearRun& plain = large_.first->encoder.run;
    const NoiseModel noise{plain.sigma, 0.0};
    projector_ = std::make_unique<Projector>(noise.Whiten(plain, plain.nuisance.jacobian), plain.nuisance);
    nothing_ = FollowTwin(large_.first->encoder, scenario_, follow_).error_rad;
    power_ = PowerOf(plain.residual);
  }

  /// Where something began is not known of readings that were left out: onsets are looked for among all.
  /// @return false if there was none.
  bool TakeKnown(std::vector<LargeCause> known) {
    std::erase_if(known, [](const LargeCause& cause) { return cause.effect.name == "slip"; });
    if (known.empty()) return false;
    const AskedAgain asked = Ask(known);
    if (!(PowerOf(asked.left) < power_)) return false;
    double power = power_;
    for (std::size_t k = 0; k < known.size(); ++k) {
      const std::vector<EffectSettings> first(asked.effects.begin(), asked.effects.begin() + std::ptrdiff_t(k) + 1);
      const double left = PowerOf(large_.first->encoder.run.residual - Shown(first));
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
    std::vector<LargeCause> causes = SignalBlock(*guess, encoder, options_.excluded);
    AskedAgain asked = Ask(causes);
    while (DropNotHeld(asked, causes)) asked = Ask(causes);
    double power = PowerOf(asked.left);
    if (causes.empty() || causes.front().effect.name != "signal_clipping" || !(power < 0.5 * power_)) return;
    for (std::size_t k = 0; k < causes.size(); ++k) causes[k].explained = PowerWithout(k, asked) - power;
    Accept(asked, std::move(causes), kFewCauses);
  }

  /// @return true if there were any.
  static bool DropNotHeld(const AskedAgain& asked, std::vector<LargeCause>& causes) {
    const std::size_t before = causes.size();
    TakeOver(asked, causes);
    std::erase_if(causes, [](const LargeCause& cause) { return !IsHeld(cause.effect); });
    return causes.size() < before;
  }

  double PowerWithout(std::size_t k, const AskedAgain& asked) const {
    return PowerOf(large_.first->encoder.run.residual - Shown(EffectsWithout(k, asked)));
  }

  static std::vector<EffectSettings> EffectsWithout(std::size_t k, const AskedAgain& asked) {
    std::vector<EffectSettings> others = asked.effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    return others;
  }

  void TakeAll() {
    do {
      while (large_.causes.size() < kMostLarge && TakeNext()) {
      }
    } while (SearchOn());
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

  Eigen::VectorXd Shown(const std::vector<EffectSettings>& effects) const {
    return FollowTwin(large_.first->encoder, With(scenario_, effects), follow_).error_rad - nothing_;
  }

  /// Whitened, without what the free unknowns take up.
  Projected WhiteOf(const Eigen::VectorXd& rows) const {
    const Eigen::MatrixXd white = large_.first->encoder.run.sigma.cwiseInverse().asDiagonal() * rows;
    return Project(*projector_, {}, white);
  }

  double PowerOf(const Eigen::VectorXd& rows) const { return WhiteOf(rows).power[0]; }

  /// It is there with the others as they are now.
  static bool IsHeld(const EffectSettings& effect) { return Deviations(effect) > tuning::kHeadline; }

  AskedAgain Ask(const std::vector<LargeCause>& causes) const {
    return AskOf(large_.first->encoder.run.residual, causes);
  }

  /// @param rows  That the causes have to explain.
  AskedAgain AskOf(const Eigen::VectorXd& rows, const std::vector<LargeCause>& causes) const {
    return AskAgain([this](const auto& effects) { return Shown(effects); }, EffectsOf(causes), MovableOf(causes),
                    benches::encoder::Format().effects, rows, large_.first->encoder.run.sigma, *projector_);
  }

  void Accept(const AskedAgain& asked, std::vector<LargeCause> causes, int most_causes) {
    // Its signatures were for the search alone, and the next one has its own.
    (large_.last ? large_.last : large_.first)->analysis.scanner.reset();
    auto searched = SearchWith(asked, causes, For(most_causes));
    most_searched_ = most_causes;
    TakeOver(asked, causes);
    power_ = PowerOf(asked.left);
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
                               last.encoder.run.residual, large_.first->encoder.run.sigma, *projector_));
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
    AskedAgain asked = Ask(causes);
    double power = PowerOf(asked.left);
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
    const AskedAgain asked = Ask(causes);
    const double power = PowerOf(asked.left);
    if (!(power < power_ - kBetter)) return false;
    causes[k].explained += power_ - power;
    Accept(asked, std::move(causes), kFewCauses);
    return true;
  }

  /// Causes with their sizes as fitted, and what they leave.
  struct Fitted {
    std::vector<LargeCause> causes;
    AskedAgain asked;
    double power = 0.0;

    double Costs(double noise) const { return power / noise + kBetter * static_cast<double>(causes.size()); }
  };

  /// @param causes  Those that the fit makes needless are dropped.
  Fitted FittedWith(std::vector<LargeCause> causes) const {
    AskedAgain asked = Ask(causes);
    while (DropNotHeld(asked, causes)) asked = Ask(causes);
    const double power = PowerOf(asked.left);
    return {std::move(causes), std::move(asked), power};
  }

  /// With the j-th member of the k-th tie in the twin.
  std::optional<Fitted> FittedLedBy(std::size_t k, std::size_t j, const Fitted& now) const {
    std::vector<LargeCause> causes = now.causes;
    if (!LetLead(k, j, now.asked, causes)) return {};
    return FittedWith(std::move(causes));
  }

  /// Puts the j-th member of the k-th tie into the twin instead of the first, with the size that the others leave
  /// it.
  /// @return false if it cannot be asked about.
  bool LetLead(std::size_t k, std::size_t j, const AskedAgain& asked, std::vector<LargeCause>& causes) const {
    const LinearRun& plain = large_.first->encoder.run;
    const auto family = std::ranges::find_if(large_.first->families, [&](const Family& f) {
      return f.kind == Kind::kNamed && IsOf(causes[k].causes[j], f);
    });
    if (family == large_.first->families.end()) return false;
    const double explained = causes[k].explained;
    causes[k].causes[j].parameters =
        CauseFrom(*family, 0, plain.residual - Shown(EffectsWithout(k, asked)), plain.sigma, *projector_)
            .parameters;
    causes[k].causes.front().parameters.clear();  // it is not what is fitted
    causes[k] = LedBy(causes[k].causes, j, plain.bench);
    causes[k].explained = explained;
    for (std::size_t i = 0; i < causes.size(); ++i) {
      if (i != k) causes[i].effect = asked.effects[i];
    }
    return !MovableOf({causes[k]}).empty();
  }

  double Memory(const Eigen::VectorXd& rows) const {
    return MemoryOf(WhiteOf(rows).rows.col(0), large_.first->encoder.run.schedule.pass);
  }

  /// @param ties  By cause, the members that explain as much as the one that leads it now.
  /// @return the first that is clearly better led by another one.
  std::optional<Fitted> BetterLed(const Fitted& now, std::vector<std::vector<Cause>>& ties) const {
    ties.clear();
    const double memory = Memory(now.asked.left);
    for (std::size_t k = 0; k < now.causes.size(); ++k) {
      ties.push_back({now.causes[k].causes.front()});
      for (std::size_t j = 1; j < now.causes[k].causes.size(); ++j) {
        std::optional<Fitted> other = FittedLedBy(k, j, now);
        if (!other) continue;
        const double of_rest = std::max(1.0, std::min(other->power, now.power) / projector_->DegreesOfFreedom());
        const double noise = std::max(memory * of_rest, kAsExact * now.causes[k].explained / kBetter);
        const double more = other->Costs(noise) - now.Costs(noise);
        if (more < -0.5 * kBetter) return other;
        if (more <= kBetter) ties.back().push_back(now.causes[k].causes[j]);
      }
    }
    return {};
  }

  /// Causes that are one to first order are not when they are large, or beside large ones. Which of them is in the twin
  /// is settled with all causes there: what one lacks would be taken for another cause before. Plain waves are, unless
  /// another member leaves less or makes a cause needless.
  void EndTies() {
    if (large_.causes.empty()) return;
    Fitted now = FittedWith(large_.causes);
    std::vector<std::vector<Cause>> ties;
    bool is_changed = false;
    std::size_t rounds = 0;  // noise is judged anew each time: two might be better than each other
    for (std::optional<Fitted> better = BetterLed(now, ties); better && rounds < kMostLarge; better = BetterLed(now, ties), ++rounds) {
      now = *std::move(better);
      is_changed = true;
    }
    for (std::size_t k = 0; k < now.causes.size(); ++k) {
      if (ties[k].size() == 1 && now.causes[k].causes.size() > 1) ties[k].front().probability = tuning::kListed;
      now.causes[k].causes = std::move(ties[k]);
    }
    if (is_changed) {
      Accept(now.asked, std::move(now.causes), kMostCauses);
    } else {
      large_.causes = std::move(now.causes);
    }
  }

  /// A wave of an order that a large cause has is what that lacks beside the others that the last search found; what is
  /// less than a device is as exact as its formula is no cause.
  void LeaveToLarge() {
    if (!large_.last) return;
    double explained = 0.0;
    for (const LargeCause& cause : large_.causes) explained += cause.explained;
    const auto is_of_large = [this](const Term& term) {
      const Family& family = large_.last->families[static_cast<std::size_t>(term.family)];
      return std::ranges::any_of(large_.causes, [&](const LargeCause& cause) {
        return cause.effect.name == family.effect && term.shape.size() == 1 && WaveOrderOf(cause.effect) == term.shape[0];
      });
    };
    std::erase_if(large_.last->analysis.found.terms,
                  [&](const Term& term) { return term.explained < kAsExact * explained || is_of_large(term); });
  }

  /// What stood for something that was found later is not kept, nor what the memory of the rest makes by chance.
  void DropNeedless() {
    if (large_.causes.empty()) return;
    const AskedAgain beside = AskOf(Beside(), large_.causes);
    const Eigen::VectorXd left = WhiteOf(beside.left).rows.col(0);
    const double memory = Memory(beside.left);
    std::vector<LargeCause> kept;
    for (std::size_t k = 0; k < large_.causes.size(); ++k) {
      const Eigen::VectorXd own = Shown(beside.effects) - Shown(EffectsWithout(k, beside));
      const double most = std::max(memory, MemoryAlong(WhiteOf(own).rows.col(0), left));
      if (Deviations(large_.causes[k].effect) > tuning::kHeadline * std::sqrt(most)) kept.push_back(large_.causes[k]);
    }
    if (kept.size() == large_.causes.size()) return;
    if (kept.empty()) return SearchPlain();
    const AskedAgain asked = Ask(kept);
    Accept(asked, std::move(kept), kMostCauses);
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
    std::vector<EffectSettings> others = EffectsOf(large_.causes);
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    EncoderRun encoder = BuildRun(readings_, With(scenario_, others), follow_);
    encoder.run.sigma = large_.Last().encoder.run.sigma;
    for (const Term& term : large_.Last().analysis.found.terms) encoder.run.residual -= term.columns * term.amplitudes;
    LeaveFree(large_.targets, encoder);
    const auto searched = SearchIn(std::move(encoder), options_.excluded, For(1));
    if (searched->analysis.found.terms.empty()) return {};
    return AnswerOf(searched->analysis.found, 0, searched->families).causes;
  }

  std::unique_ptr<Searched> SearchWith(const AskedAgain& asked, const std::vector<LargeCause>& causes,
                                       const AnalysisOptions& how) const {
    EncoderRun encoder = BuildRun(readings_, With(scenario_, asked.effects), follow_);
    LeaveFree(large_.targets, encoder);
    LeaveFree(asked, encoder.run.nuisance);
    TellSignalZero(asked.effects, encoder.context.device);
    return SearchIn(std::move(encoder), Excluded(causes), how);
  }

  /// What is small was found with the parameters of the large causes free: these go to where they are best beside
  /// it.
  void MoveBesideTheRest() {
    if (large_.causes.empty()) return;
    AskedAgain asked = AskOf(Beside(), large_.causes);
    const double more = std::sqrt(Memory(asked.left));
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
    Eigen::VectorXd before = Eigen::VectorXd::Zero(nothing_.size());
    for (LargeCause& cause : large_.causes) {
      effects.push_back(cause.effect);
      const Eigen::VectorXd shown = Shown(effects);
      cause.shown = shown - before;
      before = shown;
    }
  }

  const std::vector<Reading>& readings_;
  const Scenario& scenario_;
  const DiagnoseOptions& options_;
  const model::FollowMaker& follow_;
  AnalysisOptions how_;
  NullCalibration null_;
  LargeCauses large_;
  int most_searched_ = kFewCauses;        // causes that the last search might take
  std::unique_ptr<Projector> projector_;  // with no more than the noise of the readings
  Eigen::VectorXd nothing_;
  double power_ = 0.0;
};

}  // namespace

LargeCauses FindLargeCauses(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const model::FollowMaker& follow) {
  const std::vector<Reading> part = PartOf(readings);
  std::vector<LargeCause> known;
  if (part.size() < readings.size()) known = Search(part, scenario, options, follow, {}).Look();
  LargeCauses plain = Search(readings, scenario, options, follow, {}).Go(known);
  const Eigen::MatrixXd targets = Targets(plain.first->encoder.context);
  if (targets.size() == 0 || !LeaveErrorsOfTargets(plain, targets)) return plain;
  return Search(readings, scenario, options, follow, targets).Go(known);
}

}  // namespace twinbench::diagnose::encoder
