#include "twin/diagnose/asked_again.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/robust_scale.h"
#include "twin/diagnose/engine/fit_within.h"

namespace twinbench::diagnose {
namespace {

/// Parameters in units of what is known of them, so that one step suits all; they begin at this, so that a relative
/// step has a size.
constexpr double kBegin = 10.0;

struct Scaled {
  std::vector<EffectSettings> effects;
  std::vector<Movable> movable;

  std::vector<EffectSettings> At(const Eigen::VectorXd& x) const {
    std::vector<EffectSettings> at = effects;
    for (std::size_t k = 0; k < movable.size(); ++k)
      at[movable[k].effect].parameters[movable[k].parameter] +=
          (x[static_cast<Eigen::Index>(k)] - kBegin) * movable[k].sd;
    return at;
  }
};

const EffectParameter& EntryOf(const std::vector<EffectEntry>& catalogue, const std::string& effect,
                               const std::string& parameter) {
  const auto entry = std::ranges::find(catalogue, effect, &EffectEntry::name);
  Require(entry != catalogue.end(), "an effect that is asked about is in the catalogue");
  const auto found = std::ranges::find(entry->parameters, parameter, &EffectParameter::name);
  Require(found != entry->parameters.end(), "a parameter that is moved is in the catalogue");
  return *found;
}

/// What is left, whitened and projected.
struct Left {
  const Shows& shows;
  const Scaled& scaled;
  const Eigen::VectorXd& rows;
  const Eigen::VectorXd& weight;
  const Projector& projector;

  Eigen::VectorXd Of(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd left = rows - shows(scaled.At(x));
    return projector.Apply(Eigen::MatrixXd(weight.asDiagonal() * left)).col(0);
  }
};

Bounds BoundsOf(const Scaled& scaled, const std::vector<EffectEntry>& catalogue) {
  Bounds bounds{Eigen::VectorXd(std::ssize(scaled.movable)), Eigen::VectorXd(std::ssize(scaled.movable))};
  for (Eigen::Index k = 0; k < bounds.lower.size(); ++k) {
    const Movable& moved = scaled.movable[static_cast<std::size_t>(k)];
    const EffectSettings& effect = scaled.effects[moved.effect];
    const EffectParameter& p = EntryOf(catalogue, effect.name, moved.parameter);
    const double at = effect.parameters.at(moved.parameter);
    bounds.lower[k] = kBegin + (p.lower_SI - at) / moved.sd;
    bounds.upper[k] = kBegin + (p.upper_SI - at) / moved.sd;
  }
  return bounds;
}

/// Where the twin shows no numbers nobody should go. The fit is not told that it failed: it would say so on the user's screen.
Eigen::VectorXd Solve(const Left& left, const Bounds& bounds, const Eigen::VectorXd& x) {
  constexpr double kStep = 0.1;  // of what is known
  if (x.size() == 0) return x;
  const auto left_at = [&left](const Eigen::VectorXd& at, Eigen::Ref<Eigen::VectorXd> rows) {
    constexpr double kImpossible = 1e30;
    rows = left.Of(at);
    if (!rows.allFinite()) rows.setConstant(kImpossible);
    return true;
  };
  return FitWithin(left_at, left.rows.size(), x, bounds, {.most = 40, .relative_size = kStep / kBegin, .is_central = false});
}

/// Single rows that stand far out of the others count no more; several side by side are structure.
Eigen::VectorXd WithoutFar(const Eigen::VectorXd& left, Eigen::VectorXd weight, int& far) {
  constexpr double kFar = 8.0;      // deviations of the middle half
  constexpr double kHardly = 1e-4;  // no row has no weight: the projector was made for all of them
  const double scale = std::max(RobustDeviation(left), 1e-12);
  const auto is_far = [&](Eigen::Index i) { return i >= 0 && i < left.size() && std::abs(left[i]) > kFar * scale; };
  far = 0;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    if (!is_far(i) || is_far(i - 1) || is_far(i + 1)) continue;
    weight[i] *= kHardly;
    ++far;
  }
  return weight;
}

/// Slopes by parameter, SI. One that was driven to its bound, where the twin shows no numbers beyond, stays there: it has none.
Eigen::MatrixXd SlopesAt(const Shows& shows, const Scaled& scaled, const Bounds& bounds, Eigen::Index rows, const Eigen::VectorXd& x) {
  constexpr double kStep = 1e-2;  // of what is known
  constexpr double kAtBound = 1e-6;
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(rows, x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (x[k] < bounds.lower[k] + kAtBound || x[k] > bounds.upper[k] - kAtBound) continue;
    Eigen::VectorXd above = x, below = x;
    above[k] = std::min(x[k] + kStep, bounds.upper[k]);
    below[k] = std::max(x[k] - kStep, bounds.lower[k]);
    const double step = (above[k] - below[k]) * scaled.movable[static_cast<std::size_t>(k)].sd;
    slopes.col(k) = (shows(scaled.At(above)) - shows(scaled.At(below))) / step;
  }
  return slopes;
}

void StateUncertainties(const Projector& projector, const Eigen::VectorXd& weight, double variance,
                        const std::vector<Movable>& movable, AskedAgain& asked) {
  if (movable.empty()) return;
  const Eigen::MatrixXd white = weight.asDiagonal() * asked.slopes * asked.sd.asDiagonal();
  Eigen::MatrixXd normal = white.transpose() * projector.Apply(white);
  normal.diagonal().array() += variance;  // no parameter is known worse than it was thought of
  const Eigen::MatrixXd cov = variance * InverseOfSymmetric(normal);
  for (std::size_t k = 0; k < movable.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    asked.effects[movable[k].effect].finding.u[movable[k].parameter] = std::sqrt(cov(at, at)) * asked.sd[at];
  }
}

}  // namespace

AskedAgain AskAgain(const Shows& shows, std::vector<EffectSettings> effects, const std::vector<Movable>& movable,
                    const std::vector<EffectEntry>& catalogue, const Eigen::VectorXd& rows,
                    const Eigen::VectorXd& sigma, const Projector& projector) {
  const Scaled scaled{std::move(effects), movable};
  Eigen::VectorXd weight = sigma.cwiseInverse();
  AskedAgain asked;
  const Bounds bounds = BoundsOf(scaled, catalogue);
  const Left all{shows, scaled, rows, weight, projector};
  Eigen::VectorXd x = Solve(all, bounds, Eigen::VectorXd::Constant(std::ssize(movable), kBegin));
  weight = WithoutFar(all.Of(x), weight, asked.far);
  const Left near{shows, scaled, rows, weight, projector};
  if (asked.far > 0) x = Solve(near, bounds, x);
  asked.effects = scaled.At(x);
  asked.left = rows - shows(asked.effects);
  asked.slopes = SlopesAt(shows, scaled, bounds, rows.size(), x);
  asked.sd.resize(x.size());
  for (std::size_t k = 0; k < movable.size(); ++k) {
    const EffectSettings& effect = asked.effects[movable[k].effect];
    const EffectParameter& p = EntryOf(catalogue, effect.name, movable[k].parameter);
    asked.sd[static_cast<Eigen::Index>(k)] =
        std::max({std::abs(effect.parameters.at(p.name)), 10.0 * movable[k].sd, 1e-12});
  }
  asked.power = near.Of(x).squaredNorm();
  const double degrees = std::max(1.0, projector.DegreesOfFreedom() - static_cast<double>(movable.size()));
  StateUncertainties(projector, weight, asked.power / degrees, movable, asked);
  return asked;
}

}  // namespace twinbench::diagnose
