#include "twin/benches/encoder_comparison/diagnosis/large_cause.h"

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

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
