#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
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
#include "twin/diagnose/gain.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Length of a signature in units of noise from which it is large: a hundredth of it, which is what first order may
/// well miss, is then half a deviation.
constexpr double kLarge = 50.0;
constexpr std::size_t kMostLarge = 16;

AnalysisOptions HowToSearch(const DiagnoseOptions& options) {
  AnalysisOptions how = AnalysisOptionsOf(options);
  how.most_causes = 8;  // an angle device may well have an error of many orders
  return how;
}

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
  cause.probability = family.most_probable;
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
      : readings_(readings), scenario_(scenario), options_(options), follow_(follow), how_(HowToSearch(options)) {
    large_.targets = targets;
  }

  LargeCauses Go() {
    EncoderRun begin = BuildRun(readings_, scenario_, follow_);
    LeaveFree(large_.targets, begin.run.nuisance);
    large_.first = SearchIn(std::move(begin), options_.excluded, how_);
    how_.null = &large_.first->analysis.null;
    const LinearRun& plain = large_.first->encoder.run;
    const NoiseModel noise{plain.sigma, 0.0};
    projector_ = std::make_unique<Projector>(noise.Whiten(plain, plain.nuisance.jacobian), plain.nuisance);
    nothing_ = FollowTwin(large_.first->encoder, scenario_, follow_).error_rad;
    power_ = PowerOf(large_.first->encoder.run.residual);
    TakeSignals();
    while (large_.causes.size() < kMostLarge && TakeNext()) {
    }
    DropNeedless();
    TellWhatEachShows();
    return std::move(large_);
  }

 private:
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
    const LinearRun& plain = large_.first->encoder.run;
    return AskAgain([this](const auto& effects) { return Shown(effects); }, EffectsOf(causes), MovableOf(causes),
                    benches::encoder::Format().effects, plain.residual, plain.sigma, *projector_);
  }

  void Accept(const AskedAgain& asked, std::vector<LargeCause> causes) {
    auto searched = SearchWith(asked, causes);
    TakeOver(asked, causes);
    power_ = PowerOf(asked.left);
    large_.causes = std::move(causes);
    large_.last = std::move(searched);
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
    for (std::size_t k = 0; k < causes.size(); ++k) TryOthers(k, causes, asked, power);
    Accept(asked, std::move(causes));
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
    for (std::size_t k = 0; k < causes.size(); ++k) TryOthers(k, causes, asked, power);
    Accept(asked, std::move(causes));
    return true;
  }

  /// Large causes as they are in the twin, and what they leave.
  struct Tried {
    std::vector<LargeCause> causes;
    AskedAgain asked;
    double power;
  };

  /// Causes that are one to first order are not beside large ones: the one that leaves least is in the twin, and
  /// those that leave clearly more do not tie with it.
  void TryOthers(std::size_t k, std::vector<LargeCause>& causes, AskedAgain& asked, double& power) const {
    if (causes.size() < 2) return;
    const std::vector<Cause> doubles(causes[k].causes.begin() + 1, causes[k].causes.end());
    for (const Cause& other : doubles) {
      std::optional<Tried> tried = Try(other, k, causes, asked);
      if (!tried) continue;
      constexpr double kBetter = 25.0;  // power, so many units of noise: no chance
      const double clearly =
          kBetter * std::max(1.0, std::min(power, tried->power) / projector_->DegreesOfFreedom());
      if (std::abs(tried->power - power) < clearly) continue;
      const bool is_better = tried->power < power;
      const std::string dropped = is_better ? causes[k].effect.name : other.effect;
      if (is_better) {
        causes = std::move(tried->causes);
        asked = std::move(tried->asked);
        power = tried->power;
      }
      DropDouble(dropped, causes[k].causes);
    }
  }

  /// Those that are left share what all claimed; one alone has no double any more.
  static void DropDouble(const std::string& effect, std::vector<Cause>& doubles) {
    const auto claimed = [&doubles] {
      double sum = 0.0;
      for (const Cause& cause : doubles) sum += cause.probability;
      return sum;
    };
    const double before = claimed();
    std::erase_if(doubles, [&](const Cause& cause) { return cause.effect == effect; });
    const double share = doubles.size() == 1 ? tuning::kMostProbable / claimed() : before / claimed();
    for (Cause& cause : doubles) cause.probability *= share;
  }

  /// The twin with a double in the place of cause k, fitted to what the others leave and then all together.
  std::optional<Tried> Try(const Cause& other, std::size_t k, const std::vector<LargeCause>& causes,
                           const AskedAgain& asked) const {
    const auto family = std::ranges::find_if(
        large_.first->families, [&](const Family& f) { return f.kind == Kind::kNamed && IsOf(other, f); });
    if (family == large_.first->families.end()) return std::nullopt;
    const LinearRun& plain = large_.first->encoder.run;
    Tried tried{causes, {}, 0.0};
    for (std::size_t i = 0; i < causes.size(); ++i) tried.causes[i].effect = asked.effects[i];
    std::vector<Cause>& doubles = tried.causes[k].causes;
    const auto at = std::ranges::find_if(doubles, [&](const Cause& cause) { return IsOf(cause, *family); });
    const Eigen::VectorXd left = plain.residual - Shown(EffectsWithout(k, asked));
    at->parameters = CauseFrom(*family, 0, left, plain.sigma, *projector_).parameters;
    LargeCause led = LedBy(doubles, static_cast<std::size_t>(at - doubles.begin()), plain.bench);
    if (MovableOf({led}).empty()) return std::nullopt;
    led.explained = causes[k].explained;
    tried.causes[k] = std::move(led);
    tried.asked = Ask(tried.causes);
    tried.power = PowerOf(tried.asked.left);
    return tried;
  }

  static std::vector<EffectSettings> EffectsWithout(std::size_t k, const AskedAgain& asked) {
    std::vector<EffectSettings> others = asked.effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    return others;
  }

  /// What stood for something that was found later is not kept.
  void DropNeedless() {
    std::vector<LargeCause> kept = large_.causes;
    std::erase_if(kept, [](const LargeCause& cause) { return !IsHeld(cause.effect); });
    if (kept.empty() || kept.size() == large_.causes.size()) return;
    const AskedAgain asked = Ask(kept);
    Accept(asked, std::move(kept));
  }

  std::unique_ptr<Searched> SearchWith(const AskedAgain& asked, const std::vector<LargeCause>& causes) const {
    EncoderRun encoder = BuildRun(readings_, With(scenario_, asked.effects), follow_);
    LeaveFree(large_.targets, encoder.run.nuisance);
    LeaveFree(asked, encoder.run.nuisance);
    TellSignalZero(asked.effects, encoder.context.device);
    std::vector<std::string> excluded = ThatAreOnce(causes);
    excluded.insert(excluded.end(), options_.excluded.begin(), options_.excluded.end());
    return SearchIn(std::move(encoder), excluded, how_);
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
  LargeCauses large_;
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
  LargeCauses plain = Search(readings, scenario, options, follow, {}).Go();
  const Eigen::MatrixXd targets = Targets(plain.first->encoder.context);
  if (targets.size() == 0 || !LeaveErrorsOfTargets(plain, targets)) return plain;
  return Search(readings, scenario, options, follow, targets).Go();
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
  d.alarm_p = large.first->analysis.null.PValue(large.first->analysis.found.first_statistic);
  result.accepted.insert(result.accepted.begin(), accepted.begin(), accepted.end());
  result.run = large.first->encoder.run;
  result.run.sigma = large.Last().encoder.run.sigma;
  d.gain = MeasureGain(result.run, result.noise, result.accepted);
}

}  // namespace twinbench::diagnose::encoder
