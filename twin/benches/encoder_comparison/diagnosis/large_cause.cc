#include "twin/benches/encoder_comparison/diagnosis/large_cause.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/extend.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Of the many amplitudes and phases of a wave the one with a positive amplitude and a phase from 0 to 360 deg.
void MakePositive(EffectSettings& effect) {
  const auto phase = effect.parameters.find("phase"), amplitude = effect.parameters.find("amplitude");
  if (phase == effect.parameters.end() || amplitude == effect.parameters.end()) return;
  if (amplitude->second < 0.0) phase->second += units::kPi;
  amplitude->second = std::abs(amplitude->second);
  phase->second -= units::turn * std::floor(phase->second / units::turn);
}

/// Effects that show in the same orders as one that is in the twin: they would be fitted against each other.
std::vector<std::string> InItsPlace(const EffectSettings& effect, int signal_periods) {
  using Names = std::vector<std::string>;
  static const std::vector<Names> kOnce = {{"eccentricity", "signal_offset"},
                                           {"ellipticity", "amplitude_mismatch", "quadrature_error"}};
  // Signals that are cut off show in these orders of their period; beside one that is free the others are no more than
  // two orders.
  constexpr int kOrdersOfClipping = 4;
  const std::optional<double> order = WaveOrderOf(effect);
  if (order && std::remainder(*order, kOrdersOfClipping * signal_periods) == 0.0) return {"signal_clipping"};
  if (signal_periods != 1) return {};
  const auto with = std::ranges::find_if(kOnce, [&](const Names& names) { return std::ranges::count(names, effect.name) > 0; });
  return with == kOnce.end() ? Names{} : *with;
}

/// The k-th term that was found, as the cause that was fitted; nothing if it is none.
std::optional<LargeCause> AsCause(const Searched& searched, std::size_t k) {
  const SearchResult& found = searched.analysis.found;
  const Family& family = searched.families[static_cast<std::size_t>(found.terms[k].family)];
  if (family.kind != Kind::kNamed) return {};
  const std::vector<Cause> causes = AnswerOf(found, k, searched.families).causes;
  const auto fitted = std::ranges::find_if(causes, [&](const Cause& cause) { return IsOf(cause, family); });
  if (fitted == causes.end()) return {};
  return LedBy(causes, static_cast<std::size_t>(fitted - causes.begin()), searched.encoder.run.bench);
}

}  // namespace

std::optional<double> WaveOrderOf(const EffectSettings& effect) {
  const auto order = effect.parameters.find("order");
  return order == effect.parameters.end() ? std::nullopt : std::optional(order->second);
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

Cause CauseFrom(const Family& family, int grid_point, const Eigen::VectorXd& rows, const Eigen::VectorXd& sigma,
                const Projector& projector) {
  const Eigen::MatrixXd white = sigma.cwiseInverse().asDiagonal() * family.ColumnsAt(grid_point);
  const Eigen::MatrixXd y = projector.Apply(sigma.cwiseInverse().asDiagonal() * Eigen::MatrixXd(rows));
  const Explained fit = Explain(white, projector, {}, y.col(0));
  const Eigen::MatrixXd normal = white.transpose() * fit.projected;
  const Eigen::VectorXd shape = family.ShapeAt(grid_point);
  const double left = (y.col(0) - fit.projected * fit.amplitudes).squaredNorm() / projector.DegreesOfFreedom();
  Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(normal.cols() + shape.size(), normal.cols() + shape.size());
  cov.topLeftCorner(normal.cols(), normal.cols()) = left * GeneralInverseOf(normal);
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

std::optional<LargeCause> LargestNamed(const Searched& searched) {
  const std::vector<Term>& terms = searched.analysis.found.terms;
  std::optional<LargeCause> largest;
  double most = kLarge * kLarge;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (terms[k].explained < most) continue;
    std::optional<LargeCause> cause = AsCause(searched, k);
    if (!cause) continue;
    most = terms[k].explained;
    largest = std::move(cause);
  }
  return largest;
}

bool AreOneWave(const LargeCause& a, const LargeCause& b, double apart) {
  const std::optional<double> order = WaveOrderOf(a.effect), other = WaveOrderOf(b.effect);
  return a.effect.name == b.effect.name && a.effect.where == b.effect.where && a.effect.parameters.contains("phase") &&
         order && other && std::abs(*order - *other) < apart;
}

std::optional<LargeCause> OneOfTwoWaves(const Searched& searched, double apart) {
  const std::vector<Term>& terms = searched.analysis.found.terms;
  std::vector<std::optional<LargeCause>> causes;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    causes.push_back(AsCause(searched, i));
    for (std::size_t k = 0; causes[i] && k < i; ++k) {
      if (causes[k] && AreOneWave(*causes[i], *causes[k], apart)) return terms[i].explained > terms[k].explained ? causes[i] : causes[k];
    }
  }
  return {};
}

bool IsLoop(const std::string& effect) { return effect == "backlash" || effect == "hysteresis"; }

bool LeadsBesideLatency(const std::string& effect, double size, const std::vector<LargeCause>& causes) {
  const auto is_behind = [](const LargeCause& cause) {
    return cause.effect.name == "latency" && cause.effect.parameters.at("delay") + cause.effect.parameters.at("time_constant") > 0.0;
  };
  return IsLoop(effect) && size < 0.0 && std::ranges::any_of(causes, is_behind);
}

std::vector<int> NamedLikeUnnamed(const Searched& searched) {
  constexpr double kNearly = 0.9, kSame = 1e-6;  // of what it explains; rounding
  const auto& families = searched.families;
  const SearchResult& found = searched.analysis.found;
  const auto is_named = [&](int k) { return families[static_cast<std::size_t>(k)].kind == Kind::kNamed; };
  const auto is_large_unnamed = [&](const Term& term) {
    return !is_named(term.family) && term.explained > kLarge * kLarge;
  };
  if (std::ranges::none_of(found.terms, is_large_unnamed)) return {};
  const Eigen::VectorXd explained = found.alone.explained.col(0);
  double unnamed = 0.0, named = 0.0;
  for (int k = 0; k < std::ssize(families); ++k) {
    double& most = is_named(k) ? named : unnamed;
    most = std::max(most, explained[k]);
  }
  std::vector<int> like;
  for (int k = 0; k < std::ssize(families); ++k) {
    if (is_named(k) && named > kNearly * unnamed && explained[k] >= (1.0 - kSame) * named) like.push_back(k);
  }
  return like;
}

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

std::vector<std::string> ThatAreOnce(const std::vector<LargeCause>& causes, int signal_periods) {
  constexpr std::array kSeveral = {"periodic", "reference_fault", "slip", "interpolation"};
  std::vector<std::string> once;
  for (const LargeCause& cause : causes) {
    for (const Cause& c : cause.causes) {
      if (std::ranges::count(kSeveral, c.effect) == 0) once.push_back(c.effect);
    }
    std::ranges::move(InItsPlace(cause.effect, signal_periods), std::back_inserter(once));
  }
  return once;
}

double Deviations(const EffectSettings& effect) {
  const auto entry = std::ranges::find(benches::encoder::Format().effects, effect.name, &EffectEntry::name);
  double most = 0.0;
  for (const EffectParameter& p : entry->parameters) {
    if (p.name == "zero" || p.name == "phase" || p.name == "start" || p.name == "approach") continue;
    const auto u = effect.finding.u.find(p.name);
    if (u == effect.finding.u.end() || !(u->second > 0.0)) continue;
    const double none = p.name == "level" ? 1.0 : 0.0;
    most = std::max(most, std::abs(effect.parameters.at(p.name) - none) / u->second);
    if (p.name != "offset_sin" && p.name != "delay") break;  // the others say how, not how much
  }
  return most;
}

double ChanceOfSize(double deviations, double log_places) {
  return 1.0 / (1.0 + std::exp(log_places - 0.5 * deviations * deviations));
}

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

}  // namespace twinbench::diagnose::encoder
