#include "twin/benches/circular_motion/estimators/iso230_4.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "twin/benches/circular_motion/estimators/path_noise.h"
#include "twin/benches/circular_motion/estimators/radii.h"
#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::circular {
namespace {

using Eigen::Index, Eigen::VectorXd;

Iso230_4Value With(double value_m, const PartedVariance& variance) {
  return {value_m, std::sqrt(variance.all), variance.of_steps / variance.all, variance.of_machine / variance.all};
}

/// Variance of a sum of radii with these weights by what is their own.
PartedVariance OwnOf(const Radii& radii, const VectorXd& weight) {
  PartedVariance variance;
  VectorXd of_steps_m = VectorXd::Zero(radii.Count());
  for (Index i = 0; i < radii.Count(); ++i) {
    const PartedVariance own = radii.Own(i);
    variance = variance + PartedVariance{own.all - own.of_steps, 0.0, own.of_machine} * (weight[i] * weight[i]);
    of_steps_m[radii.rounded_with[static_cast<std::size_t>(i)]] += weight[i] * std::sqrt(own.of_steps);
  }
  const double steps = of_steps_m.squaredNorm();
  return variance + PartedVariance{steps, steps, 0.0};
}

/// Noise makes an extreme larger, the more readings there are that may be it.
/// @param values_m  Among which it is one.
double BiasOfExtreme_m(const VectorXd& values_m, double extreme_m, double sigma_m) {
  constexpr double kNear = 2.0;  // standard deviations
  const auto near = static_cast<double>(((values_m.array() - extreme_m).abs() <= kNear * sigma_m).count());
  // Largest of so many normal deviates (Blom, Statistical Estimates and Transformed Beta-Variables, 1958).
  return sigma_m * NormalExceededWith(0.625 / (near + 0.25));
}

/// @param bias_m  Shared out as the variance is.
PartedVariance WithBias(const PartedVariance& own, double bias_m) {
  return own.all > 0.0 ? own * (1.0 + bias_m * bias_m / own.all) : own;
}

/// A sum of radii with these weights.
Iso230_4Value Weighted(const Radii& radii, const VectorXd& weight, const SharedUncertainty& shared) {
  const double value_m = weight.dot(radii.deviation_m);
  if (!shared.IsKnown()) return {value_m};
  const VectorXd slope = radii.slope.transpose() * weight;
  PartedVariance variance = shared.Parted(slope);
  variance.all = shared.Variance(slope);
  return With(value_m, variance + OwnOf(radii, weight));
}

/// The radius that is the largest or the smallest of all.
Iso230_4Value ExtremeOf(const Radii& radii, Index at, const SharedUncertainty& shared) {
  const double value_m = radii.deviation_m[at];
  if (!shared.IsKnown()) return {value_m};
  const VectorXd slope = radii.slope.row(at);
  PartedVariance variance = shared.Parted(slope);
  variance.all = shared.Variance(slope);
  const double bias_m = BiasOfExtreme_m(radii.deviation_m, value_m, radii.u_own_m[at]);
  return With(value_m, variance + WithBias(radii.Own(at), bias_m));
}

struct Extremes {
  Index smallest, largest;
};
Extremes ExtremesOf(const VectorXd& values) {
  Extremes at{};
  values.minCoeff(&at.smallest);
  values.maxCoeff(&at.largest);
  return at;
}

/// What the centre takes out of a difference of two radii is left out of its uncertainty: the centre is that of
/// many readings.
Iso230_4Value RangeOf(const Radii& about, const SharedUncertainty& shared) {
  const Extremes at = ExtremesOf(about.deviation_m);
  const double largest_m = about.deviation_m[at.largest], smallest_m = about.deviation_m[at.smallest], value_m = largest_m - smallest_m;
  if (!shared.IsKnown()) return {value_m};
  const double bias_m = BiasOfExtreme_m(about.deviation_m, largest_m, about.u_own_m[at.largest]) +
                        BiasOfExtreme_m(about.deviation_m, smallest_m, about.u_own_m[at.smallest]);
  return With(value_m, WithBias(about.Own(at.largest) + about.Own(at.smallest), bias_m));
}

/// Where a convex function of one number is smallest within +- half, by golden sections.
template <class Function>
double LowestAt(const Function& of, double half) {
  constexpr int kSections = 60;
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = -half, high = half, inner = high - golden * (high - low), outer = low + golden * (high - low);
  double at_inner = of(inner), at_outer = of(outer);
  for (int k = 0; k < kSections; ++k) {
    const bool left = at_inner < at_outer;
    (left ? high : low) = left ? outer : inner;
    (left ? outer : inner) = left ? inner : outer;
    (left ? at_outer : at_inner) = left ? at_inner : at_outer;
    double& probe = left ? inner : outer;
    probe = left ? high - golden * (high - low) : low + golden * (high - low);
    (left ? at_inner : at_outer) = of(probe);
  }
  return 0.5 * (low + high);
}

/// About the centre of the minimum zone: the range is a convex function of where the centre is, first one way, then the other.
Radii AboutMinimumZone(Radii about) {
  const VectorXd c = about.angle_rad.array().cos(), s = about.angle_rad.array().sin();
  const auto range_m = [](const VectorXd& r) { return r.maxCoeff() - r.minCoeff(); };
  const double half_m = range_m(about.deviation_m);
  const auto best_y_m = [&](const VectorXd& r) { return LowestAt([&](double y_m) { return range_m(r - y_m * s); }, half_m); };
  const double x_m = LowestAt(
      [&](double at_m) {
        const VectorXd r = about.deviation_m - at_m * c;
        return range_m(r - best_y_m(r) * s);
      },
      half_m);
  about.deviation_m -= x_m * c;
  about.deviation_m -= best_y_m(about.deviation_m) * s;
  return about;
}

/// Of one or both directions, about one centre.
struct Figures {
  Iso230_4Value G, G_mz, largest, smallest;
};
Figures FiguresOf(const Radii& radii, const SharedUncertainty& shared) {
  if (radii.Count() == 0) return {};
  const Radii about = AboutOwnCentre(radii);
  const Extremes at = ExtremesOf(about.deviation_m);
  return {RangeOf(about, shared), RangeOf(AboutMinimumZone(about), shared), ExtremeOf(about, at.largest, shared),
          ExtremeOf(about, at.smallest, shared)};
}

/// Of the least-squares circle, less the commanded radius: on a whole circle the mean of all radii, which on an arc goes with its centre.
Iso230_4Value MeanOf(const Radii& radii, const SharedUncertainty& shared) {
  if (radii.Count() == 0) return {};
  const Eigen::MatrixXd circle = CircleOf(radii);
  const Eigen::MatrixXd weighted = radii.stands_for.asDiagonal() * circle;
  return Weighted(radii, weighted * SolveSymmetric(circle.transpose() * weighted, VectorXd(VectorXd::Unit(circle.cols(), 2))), shared);
}

/// The readings of a pass by their angle within a turn.
std::vector<std::pair<double, Index>> ByAngle(const Radii& radii) {
  std::vector<std::pair<double, Index>> order;
  for (Index i = 0; i < radii.Count(); ++i) order.emplace_back(WithinTurn_rad(radii.angle_rad[i]), i);
  std::ranges::sort(order);
  return order;
}

/// Between which two readings an angle lies, and how far on the way from the first to the second.
struct Between {
  Index before, after;
  double share;
};
std::optional<Between> BetweenAt(const std::vector<std::pair<double, Index>>& order, double angle_rad) {
  constexpr double kWidest_rad = 15.0 * units::deg;  // an arc that was left out is no straight line
  constexpr double kSame_rad = 1e-6;
  const auto next = std::ranges::lower_bound(order, angle_rad - kSame_rad, {}, &std::pair<double, Index>::first);
  const auto& [after_rad, after] = next == order.end() ? order.front() : *next;
  const auto& [before_rad, before] = next == order.begin() ? order.back() : *std::prev(next);
  if (std::abs(std::remainder(after_rad - angle_rad, units::turn)) < kSame_rad) return Between{after, after, 1.0};
  const double from_rad = std::remainder(angle_rad - before_rad, units::turn);
  const double way_rad = from_rad + std::remainder(after_rad - angle_rad, units::turn);
  if (from_rad < 0.0 || way_rad > kWidest_rad || way_rad < from_rad) return std::nullopt;
  return Between{before, after, from_rad / way_rad};
}

/// What the readings of one pass differ by from the other pass, between whose readings it is taken linearly.
void RaiseHysteresis(const Radii& at, const Radii& other, const SharedUncertainty& shared, Iso230_4Value& largest) {
  const auto order = ByAngle(other);
  VectorXd all_m = VectorXd::Constant(at.Count(), kNaN);
  PartedVariance of_largest;
  bool is_larger = false;
  for (const auto& [angle_rad, i] : ByAngle(at)) {
    const auto between = BetweenAt(order, angle_rad);
    if (!between) continue;
    const auto& [j, k, share] = *between;
    const double apart_m = std::abs(at.deviation_m[i] - (1.0 - share) * other.deviation_m[j] - share * other.deviation_m[k]);
    all_m[i] = apart_m;
    if (apart_m <= largest.value_m) continue;
    largest.value_m = apart_m;
    is_larger = true;
    of_largest = at.Own(i) + other.Own(j) * std::pow(1.0 - share, 2) + other.Own(k) * std::pow(share, 2);
  }
  if (!is_larger || !shared.IsKnown()) return;
  const double bias_m = BiasOfExtreme_m(all_m, largest.value_m, std::sqrt(of_largest.all));
  largest = With(largest.value_m, WithBias(of_largest, bias_m));
}

/// Of any two passes of opposite directions.
Iso230_4Value Hysteresis(const std::vector<const CirclePath*>& ccw, const std::vector<const CirclePath*>& cw,
                         const SharedUncertainty& shared) {
  Iso230_4Value largest;
  for (const CirclePath* one : ccw) {
    const Radii of_one = RadiiOf({one});
    for (const CirclePath* other : cw) {
      const Radii of_other = RadiiOf({other});
      RaiseHysteresis(of_one, of_other, shared, largest);
      RaiseHysteresis(of_other, of_one, shared, largest);
    }
  }
  return largest;
}

Iso230_4 DeviationsOf(const std::vector<const CirclePath*>& paths, const SharedUncertainty& shared) {
  std::vector<const CirclePath*> counter, clockwise;
  for (const CirclePath* path : paths) (path->direction > 0 ? counter : clockwise).push_back(path);
  const Radii ccw = RadiiOf(counter), cw = RadiiOf(clockwise);
  Iso230_4 d;
  d.setup = paths.front()->setup;
  d.feed_m_s = paths.front()->feed_m_s;
  const Figures of_ccw = FiguresOf(ccw, shared), of_cw = FiguresOf(cw, shared);
  d.G_ccw = of_ccw.G;
  d.G_cw = of_cw.G;
  d.G_mz_ccw = of_ccw.G_mz;
  d.G_mz_cw = of_cw.G_mz;
  d.Fmax_ccw = of_ccw.largest;
  d.Fmin_ccw = of_ccw.smallest;
  d.Fmax_cw = of_cw.largest;
  d.Fmin_cw = of_cw.smallest;
  if (counter.empty() || clockwise.empty()) return d;
  const Radii both = RadiiOf(paths);
  const Figures of_both = FiguresOf(both, shared);
  d.G_b = of_both.G;
  d.G_mz_b = of_both.G_mz;
  d.Fmax_b = of_both.largest;
  d.Fmin_b = of_both.smallest;
  d.D = MeanOf(both, shared);
  d.H = Hysteresis(counter, clockwise, shared);
  return d;
}

}  // namespace

std::vector<std::pair<std::string, Iso230_4Value>> NamedValues(const Iso230_4& d) {
  return {{"G_ccw", d.G_ccw},
          {"G_cw", d.G_cw},
          {"G_b", d.G_b},
          {"G_mz_ccw", d.G_mz_ccw},
          {"G_mz_cw", d.G_mz_cw},
          {"G_mz_b", d.G_mz_b},
          {"Fmax_ccw", d.Fmax_ccw},
          {"Fmin_ccw", d.Fmin_ccw},
          {"Fmax_cw", d.Fmax_cw},
          {"Fmin_cw", d.Fmin_cw},
          {"Fmax_b", d.Fmax_b},
          {"Fmin_b", d.Fmin_b},
          {"D", d.D},
          {"H", d.H}};
}

double CircularDeviation_m(const std::vector<CirclePath>& paths) {
  std::vector<const CirclePath*> all;
  for (const CirclePath& path : paths) all.push_back(&path);
  const Radii radii = RadiiOf(all);
  return radii.Count() == 0 ? kNaN : RangeOf(AboutOwnCentre(radii), {}).value_m;
}

std::vector<Iso230_4> CircularDeviations(const std::vector<CirclePath>& stated, const SharedUncertainty& shared) {
  const std::vector<CirclePath> paths = shared.IsKnown() ? WithNoiseAsRead(stated) : stated;
  std::vector<std::vector<const CirclePath*>> groups;
  for (const CirclePath& path : paths) {
    const auto group = std::ranges::find_if(groups, [&](const auto& g) {
      return g.front()->setup == path.setup && g.front()->feed_m_s == path.feed_m_s;
    });
    if (group == groups.end())
      groups.push_back({&path});
    else
      group->push_back(&path);
  }
  std::vector<Iso230_4> deviations;
  for (const auto& group : groups) deviations.push_back(DeviationsOf(group, shared));
  return deviations;
}

}  // namespace twinbench::separate::circular
