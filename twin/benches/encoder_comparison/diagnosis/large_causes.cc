#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/part_of_readings.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_block.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_guess.h"
#include "twin/benches/encoder_comparison/diagnosis/stop_errors.h"
#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/units.h"
#include "twin/diagnose/asked_again.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Length of a signature in units of noise from which it is large: a hundredth of it, which is what first order may
/// well miss, is then half a deviation.
constexpr double kLarge = 50.0;
constexpr std::size_t kMostLarge = 16;
/// An angle device may well have an error of many orders. As long as something large is found, the first few are
/// enough: what a large cause leaves to first order is explained by shapes that are gone once the twin has it.
constexpr int kMostCauses = 8, kFewCauses = 3;

std::unique_ptr<Searched> SearchIn(EncoderRun encoder, const std::vector<std::string>& excluded,
                                   const AnalysisOptions& how) {
  auto searched = std::make_unique<Searched>(Searched{std::move(encoder), {}, {}});
  searched->families = Families(searched->encoder, excluded);
  searched->analysis = Analyse(searched->encoder.run, searched->families, how);
  return searched;
}

bool IsOf(const Cause& cause, const Family& family) {
  return cause.effect == family.effect && cause.where == family.where;
}

/// A family at a point of its grid as a cause, from rows that it has to explain alone.
/// @param sigma  Of every row.
Cause CauseFrom(const Family& family, int grid_point, const Eigen::VectorXd& rows, const Eigen::VectorXd& sigma,
                const Projector& projector) {
  const Eigen::MatrixXd white = sigma.cwiseInverse().asDiagonal() * family.ColumnsAt(grid_point);
  const Eigen::MatrixXd y = projector.Apply(sigma.cwiseInverse().asDiagonal() * Eigen::MatrixXd(rows));
  const Explained fit = Explain(white, projector, {}, y.col(0));
  const Eigen::MatrixXd normal = white.transpose() * fit.projected;
  const Eigen::VectorXd shape = family.ShapeAt(grid_point);
  const double left = (y.col(0) - fit.projected * fit.amplitudes).squaredNorm() / projector.DegreesOfFreedom();
  Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(normal.cols() + shape.size(), normal.cols() + shape.size());
  cov.topLeftCorner(normal.cols(), normal.cols()) = left * normal.completeOrthogonalDecomposition().pseudoInverse();
  for (std::size_t k = 0; k < family.shapes.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const Range cell = Around(family.shapes[k], shape[at]);
    cov(normal.cols() + at, normal.cols() + at) = std::pow(0.25 * (cell.upper - cell.lower), 2);
  }
  Cause cause;
  cause.effect = family.effect;
  cause.where = family.where;
  cause.probability = family.listed;
  cause.rho = std::sqrt(fit.power);
  if (family.parameters) {
    cause.parameters = family.parameters(shape, fit.amplitudes, cov);
    return cause;
  }
  for (Eigen::Index k = 0; k < normal.cols(); ++k) {
    const Amplitude& a = family.amplitudes[static_cast<std::size_t>(k)];
    cause.parameters.push_back(
        {a.name, a.unit, a.to_SI, fit.amplitudes[k], std::sqrt(cov(k, k)), a.lower, a.upper});
  }
  return cause;
}

LargeCause LedBy(std::vector<Cause> causes, std::size_t leader, const std::string& bench) {
  std::swap(causes.front(), causes[leader]);
  const EffectSettings effect = EffectOf(causes.front(), bench, "");
  return {std::move(causes), effect, 0.0, {}};
}

/// The largest of what has a name, the one that was fitted first.
std::optional<LargeCause> LargestNamed(const Searched& searched) {
  const SearchResult& found = searched.analysis.found;
  std::optional<LargeCause> largest;
  double most = kLarge * kLarge;
  for (std::size_t k = 0; k < found.terms.size(); ++k) {
    const Family& family = searched.families[static_cast<std::size_t>(found.terms[k].family)];
    if (family.kind != Kind::kNamed || found.terms[k].explained < most) continue;
    const std::vector<Cause> causes = AnswerOf(found, k, searched.families).causes;
    const auto fitted = std::ranges::find_if(causes, [&](const Cause& cause) { return IsOf(cause, family); });
    if (fitted == causes.end()) continue;
    most = found.terms[k].explained;
    largest = LedBy(causes, static_cast<std::size_t>(fitted - causes.begin()), searched.encoder.run.bench);
  }
  return largest;
}

/// A large shape without a name may be a cause whose signature bends: the one that explains nearly as much alone.
int NamedLikeUnnamed(const Searched& searched) {
  constexpr double kNearly = 0.9;  // of what it explains
  const Evidence& alone = searched.analysis.found.alone;
  int best = -1;
  double unnamed = kLarge * kLarge, named = 0.0;
  for (int k = 0; k < std::ssize(searched.families); ++k) {
    const double explained = alone.explained.size() > 0 ? alone.explained(k, 0) : 0.0;
    if (searched.families[static_cast<std::size_t>(k)].kind == Kind::kUnknown) {
      unnamed = std::max(unnamed, explained);
    } else if (explained > named) {
      named = explained;
      best = k;
    }
  }
  return named > kNearly * unnamed ? best : -1;
}

/// What may be asked for other values: not a whole number, nor how stops were reached, which a longer crossing
/// imitates.
std::vector<Movable> MovableOf(const std::vector<LargeCause>& causes) {
  constexpr std::array kWhole = {"order", "teeth", "at_reading", "approach"};
  std::vector<Movable> movable;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    for (const ParameterEstimate& p : causes[k].causes.front().parameters) {
      if (!(p.u > 0.0) || std::ranges::count(kWhole, p.name) > 0) continue;
      movable.push_back({k, p.name, std::max(p.u, 1e-6 * std::abs(p.value))});
    }
  }
  return movable;
}

std::vector<EffectSettings> EffectsOf(const std::vector<LargeCause>& causes) {
  std::vector<EffectSettings> effects;
  for (const LargeCause& cause : causes) effects.push_back(cause.effect);
  return effects;
}

Scenario With(Scenario scenario, const std::vector<EffectSettings>& effects) {
  scenario.effects.insert(scenario.effects.end(), effects.begin(), effects.end());
  return scenario;
}

/// Those of which a bench has no second one. What is not left when it is in the twin was never there twice.
std::vector<std::string> ThatAreOnce(const std::vector<LargeCause>& causes) {
  constexpr std::array kSeveral = {"periodic", "reference_fault", "slip", "interpolation"};
  std::vector<std::string> once;
  for (const LargeCause& cause : causes) {
    for (const Cause& c : cause.causes) {
      if (std::ranges::count(kSeveral, c.effect) == 0) once.push_back(c.effect);
    }
  }
  return once;
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
void LeaveFree(const Eigen::MatrixXd& targets, Nuisance& nuisance) {
  const double precision = nuisance.prior_precision[0];
  AskedAgain any;
  any.slopes = targets;
  any.sd = Eigen::VectorXd::Constant(targets.cols(), 1.0 / std::sqrt(precision));
  if (targets.cols() > 0) LeaveFree(any, nuisance);
}

/// Of the many amplitudes and phases of a wave the one with a positive amplitude and a phase from 0 to 360 deg.
void MakePositive(EffectSettings& effect) {
  const auto phase = effect.parameters.find("phase"), amplitude = effect.parameters.find("amplitude");
  if (phase == effect.parameters.end() || amplitude == effect.parameters.end()) return;
  if (amplitude->second < 0.0) phase->second += units::kPi;
  amplitude->second = std::abs(amplitude->second);
  phase->second -= units::turn * std::floor(phase->second / units::turn);
}

/// How many of its uncertainties the size of a cause is away from nothing: from zero, or from signals that are
/// whole.
double Deviations(const EffectSettings& effect) {
  const auto entry = std::ranges::find(benches::encoder::Format().effects, effect.name, &EffectEntry::name);
  double most = 0.0;
  for (const EffectParameter& p : entry->parameters) {
    if (p.name == "zero" || p.name == "phase" || p.name == "start" || p.name == "approach") continue;
    const auto u = effect.finding.u.find(p.name);
    if (u == effect.finding.u.end() || !(u->second > 0.0)) continue;
    const double none = p.name == "level" ? 1.0 : 0.0;
    most = std::max(most, std::abs(effect.parameters.at(p.name) - none) / u->second);
    if (p.name != "offset_sin") break;  // the others say how, not how much
  }
  return most;
}

/// What was asked, in the words of the causes.
void TakeOver(const AskedAgain& asked, std::vector<LargeCause>& causes) {
  for (std::size_t k = 0; k < causes.size(); ++k) {
    causes[k].effect = asked.effects[k];
    MakePositive(causes[k].effect);
    for (ParameterEstimate& p : causes[k].causes.front().parameters) {
      p.value = causes[k].effect.parameters.at(p.name);
      const auto u = asked.effects[k].finding.u.find(p.name);
      if (u != asked.effects[k].finding.u.end()) p.u = u->second;
    }
  }
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
    DropNeedless();
    EndTies();
    MoveBesideTheRest();
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
    return how;
  }

  void Begin(int most_causes) {
    EncoderRun begin = BuildRun(readings_, scenario_, follow_);
    LeaveFree(large_.targets, begin.run.nuisance);
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
    for (std::size_t k = 0; k < causes.size(); ++k) TryOthers(k, false, causes, asked, power);
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

  /// For more causes, where the last search ended at a few, or took for noise what more of them would explain.
  /// @return false if it did not.
  bool SearchOn() {
    std::unique_ptr<Searched>& last = large_.last ? large_.last : large_.first;
    const bool is_cut = std::ssize(last->analysis.found.terms) == most_searched_ || !last->analysis.repairs.empty();
    if (!is_cut || most_searched_ == kMostCauses) return false;
    last->analysis.scanner.reset();
    last = SearchIn(std::move(last->encoder), Excluded(large_.causes), For(kMostCauses));
    most_searched_ = kMostCauses;
    return true;
  }

  std::vector<std::string> Excluded(const std::vector<LargeCause>& causes) const {
    std::vector<std::string> excluded = ThatAreOnce(causes);
    excluded.insert(excluded.end(), options_.excluded.begin(), options_.excluded.end());
    return excluded;
  }

  Eigen::VectorXd Shown(const std::vector<EffectSettings>& effects) const {
    return FollowTwin(large_.first->encoder, With(scenario_, effects), follow_).error_rad - nothing_;
  }

  double PowerOf(const Eigen::VectorXd& rows) const {
    const Eigen::MatrixXd white = large_.first->encoder.run.sigma.cwiseInverse().asDiagonal() * rows;
    return Project(*projector_, {}, white).power[0];
  }

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
    const int like = NamedLikeUnnamed(large_.Last());
    if (like < 0) return false;
    const Searched& last = large_.Last();
    const Cause cause =
        CauseFrom(last.families[static_cast<std::size_t>(like)], last.analysis.found.alone.grid_point(like, 0),
                  last.encoder.run.residual, large_.first->encoder.run.sigma, *projector_);
    return Take(LedBy({cause}, 0, last.encoder.run.bench));
  }

  bool Take(const LargeCause& next) {
    std::vector<LargeCause> causes = large_.causes;
    causes.push_back(next);
    // Of a cause whose size is not known there is nothing to be asked.
    if (MovableOf({next}).empty()) return false;
    AskedAgain asked = Ask(causes);
    double power = PowerOf(asked.left);
    if (!(power < power_) || !IsHeld(asked.effects.back())) return false;
    causes.back().explained = power_ - power;
    for (std::size_t k = 0; k < causes.size(); ++k) TryOthers(k, false, causes, asked, power);
    Accept(asked, std::move(causes), kFewCauses);
    return true;
  }

  /// Causes that are one to first order are not beside large ones: the one that leaves least is in the twin.
  /// @param at_end  All causes are there: what leaves more than another is no tie any more.
  void TryOthers(std::size_t k, bool at_end, std::vector<LargeCause>& causes, AskedAgain& asked,
                 double& power) const {
    if (causes.size() < 2) return;
    std::vector<Cause> as_likely = {causes[k].causes.front()};
    for (std::size_t j = 1; j < causes[k].causes.size(); ++j) {
      as_likely.push_back(causes[k].causes[j]);
      std::vector<LargeCause> changed = causes;
      if (!LetLead(k, j, asked, changed)) continue;
      AskedAgain again = Ask(changed);
      const double left = PowerOf(again.left);
      constexpr double kBetter = 25.0;  // power, so many units of noise: no chance
      const double noise = std::max(1.0, std::min(left, power) / projector_->DegreesOfFreedom());
      if (left > power + kBetter * noise) as_likely.pop_back();
      if (!(left < power - kBetter * noise)) continue;
      causes = std::move(changed);
      asked = std::move(again);
      power = left;
      as_likely = {causes[k].causes.front()};
      if (!at_end) return;
    }
    if (!at_end) return;
    if (as_likely.size() == 1 && causes[k].causes.size() > 1) as_likely.front().probability = tuning::kListed;
    causes[k].causes = std::move(as_likely);
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

  void EndTies() {
    std::vector<LargeCause> causes = large_.causes;
    AskedAgain asked;
    asked.effects = EffectsOf(causes);
    double power = power_;
    for (std::size_t k = 0; k < causes.size(); ++k) TryOthers(k, true, causes, asked, power);
    if (power < power_) {
      Accept(asked, std::move(causes), kMostCauses);
    } else {
      large_.causes = std::move(causes);
    }
  }

  /// What stood for something that was found later is not kept.
  void DropNeedless() {
    std::vector<LargeCause> kept = large_.causes;
    std::erase_if(kept, [](const LargeCause& cause) { return !IsHeld(cause.effect); });
    if (kept.empty() || kept.size() == large_.causes.size()) return;
    const AskedAgain asked = Ask(kept);
    Accept(asked, std::move(kept), kMostCauses);
  }

  std::unique_ptr<Searched> SearchWith(const AskedAgain& asked, const std::vector<LargeCause>& causes,
                                       const AnalysisOptions& how) const {
    EncoderRun encoder = BuildRun(readings_, With(scenario_, asked.effects), follow_);
    LeaveFree(large_.targets, encoder.run.nuisance);
    LeaveFree(asked, encoder.run.nuisance);
    TellSignalZero(asked.effects, encoder.context.device);
    return SearchIn(std::move(encoder), Excluded(causes), how);
  }

  /// What is small was found with the parameters of the large causes free: these go to where they are best beside
  /// it.
  void MoveBesideTheRest() {
    const std::vector<Term>& terms = large_.Last().analysis.found.terms;
    if (large_.causes.empty() || terms.empty()) return;
    Eigen::VectorXd rows = large_.first->encoder.run.residual;
    for (const Term& term : terms) rows -= term.columns * term.amplitudes;
    TakeOver(AskOf(rows, large_.causes), large_.causes);
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

Accepted AcceptedOf(const LargeCause& cause) {
  Accepted accepted;
  accepted.family.effect = cause.effect.name;
  accepted.family.where = cause.effect.where;
  accepted.family.amplitudes = {{"strength", "1", 1.0, 1.0}};
  accepted.amplitudes = Eigen::VectorXd::Ones(1);
  accepted.columns = cause.shown;
  return accepted;
}

/// Power of what has no name beside the large causes, in units of the noise that was thought of at first.
double UnnamedOf(const LargeCauses& large) {
  const Searched& last = large.Last();
  double unnamed = 0.0;
  for (const Term& term : last.analysis.found.terms) {
    const Family& family = last.families[static_cast<std::size_t>(term.family)];
    if (family.kind == Kind::kUnknown) unnamed += term.explained;
  }
  const double sigma = last.encoder.run.sigma.mean() / large.first->encoder.run.sigma.mean();
  return unnamed * sigma * sigma;
}

/// What has no name beside the large causes is said; it makes an unknown of the whole only if it is no small part.
/// A cause may be no more than a piece of it: it is as sure as it is large beside it.
void WeighTheRest(const LargeCauses& large, Diagnosis& d, std::vector<Cause>& causes) {
  if (d.verdict != Verdict::kUnknown) return;
  const double unnamed = UnnamedOf(large);
  double all = unnamed;
  for (const LargeCause& cause : large.causes) all += cause.explained;
  auto at = causes.begin();
  for (const LargeCause& cause : large.causes) {
    for (std::size_t k = 0; k < cause.causes.size(); ++k, ++at)
      at->probability *= cause.explained / (cause.explained + unnamed);
  }
  if (unnamed > tuning::kSmallRest * all) return;
  d.notes.push_back(fmt::format("beside these, significant but small: {}", d.unknown.signature));
  d.verdict = Verdict::kNamed;
}

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

void AddLargeCauses(const LargeCauses& large, DiagnosisRun& result) {
  if (large.causes.empty()) return;
  Diagnosis& d = result.diagnosis;
  if (d.verdict == Verdict::kNone) d.verdict = Verdict::kNamed;
  std::vector<Cause> causes;
  std::vector<Accepted> accepted;
  for (const LargeCause& cause : large.causes) {
    causes.insert(causes.end(), cause.causes.begin(), cause.causes.end());
    accepted.push_back(AcceptedOf(cause));
  }
  WeighTheRest(large, d, causes);
  const bool is_tie = std::ranges::any_of(large.causes, [](const LargeCause& c) { return c.causes.size() > 1; });
  if (is_tie && d.verdict == Verdict::kNamed) d.verdict = Verdict::kTie;
  d.causes.insert(d.causes.begin(), causes.begin(), causes.end());
  d.alarm_p = result.structure_p = large.first->analysis.null.PValue(large.first->analysis.found.first_statistic);
  result.accepted.insert(result.accepted.begin(), accepted.begin(), accepted.end());
  result.run = large.first->encoder.run;
  result.run.sigma = large.Last().encoder.run.sigma;
}

}  // namespace twinbench::diagnose::encoder
