#include "twin/benches/circular_motion/estimators/iso230_4.h"

#include <algorithm>

#include "twin/core/linear_algebra.h"

namespace twinbench::separate::circular {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Radii about the commanded centre, less the nominal one, of one or two paths; and what they lean on.
struct Radii {
  VectorXd deviation_m, u_own_m, of_machine, of_steps, angle_rad;  // of_: shares of the square of u_own_m
  Eigen::MatrixXd slope;  // rows x unknowns

  Index Count() const { return deviation_m.size(); }
  PartedVariance Own(Index i) const {
    const double all = u_own_m[i] * u_own_m[i];
    return {all, of_steps[i] * all, of_machine[i] * all};
  }
};

Radii RadiiOf(const std::vector<const CirclePath*>& paths) {
  std::vector<const PathPoint*> points;
  Radii radii;
  std::vector<double> nominal_m;
  for (const CirclePath* path : paths) {
    for (const PathPoint& point : path->points) {
      points.push_back(&point);
      nominal_m.push_back(path->radius_m);
    }
  }
  const Index count = std::ssize(points);
  radii.deviation_m.resize(count);
  radii.u_own_m.resize(count);
  radii.of_machine.resize(count);
  radii.of_steps.resize(count);
  radii.angle_rad.resize(count);
  radii.slope.resize(count, points.empty() ? 0 : points.front()->slope.cols());
  for (Index i = 0; i < count; ++i) {
    const PathPoint& point = *points[static_cast<std::size_t>(i)];
    const double radius_m = nominal_m[static_cast<std::size_t>(i)];
    const double c = std::cos(point.commanded_rad), s = std::sin(point.commanded_rad);
    radii.deviation_m[i] = std::hypot(radius_m * c + point.d_m.x(), radius_m * s + point.d_m.y()) - radius_m;
    radii.u_own_m[i] = point.u_own_m.x();
    radii.of_machine[i] = point.of_machine.x();
    radii.of_steps[i] = point.of_steps.x();
    radii.angle_rad[i] = point.commanded_rad;
    if (radii.slope.cols() > 0) radii.slope.row(i) = c * point.slope.row(0) + s * point.slope.row(1);
  }
  return radii;
}

Iso230_4Value With(double value_m, const PartedVariance& variance) {
  return {value_m, std::sqrt(variance.all), variance.of_steps / variance.all, variance.of_machine / variance.all};
}

/// A sum of radii with these weights.
Iso230_4Value Weighted(const Radii& radii, const VectorXd& weight, const SharedUncertainty& shared) {
  const double value_m = weight.dot(radii.deviation_m);
  if (!shared.IsKnown()) return {value_m};
  const VectorXd slope = radii.slope.transpose() * weight;
  PartedVariance variance = shared.Parted(slope);
  variance.all = shared.Variance(slope);
  for (Index i = 0; i < radii.Count(); ++i) {
    const double square = weight[i] * weight[i];
    const PartedVariance own = radii.Own(i);
    variance = variance + PartedVariance{square * own.all, square * own.of_steps, square * own.of_machine};
  }
  return With(value_m, variance);
}

VectorXd Only(const Radii& radii, Index i) {
  return VectorXd::Unit(radii.Count(), i);
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

/// The radii from their least-squares centre.
VectorXd AboutOwnCentre(const Radii& radii) {
  Eigen::MatrixXd circle(radii.Count(), 3);
  circle << radii.angle_rad.array().cos(), radii.angle_rad.array().sin(), VectorXd::Ones(radii.Count());
  const VectorXd fit = SolveLeastSquares(circle, radii.deviation_m);
  return radii.deviation_m - circle.leftCols(2) * fit.head(2);
}

/// What the centre takes out of a difference of two radii is left out of its uncertainty: the centre is that of
/// many readings.
Iso230_4Value Circular(const Radii& radii, const SharedUncertainty& shared) {
  if (radii.Count() == 0) return {};
  const VectorXd about_m = AboutOwnCentre(radii);
  const Extremes at = ExtremesOf(about_m);
  const double value_m = about_m[at.largest] - about_m[at.smallest];
  return shared.IsKnown() ? With(value_m, radii.Own(at.largest) + radii.Own(at.smallest)) : Iso230_4Value{value_m};
}

struct Radial {
  Iso230_4Value largest, smallest;
};
Radial RadialOf(const Radii& radii, const SharedUncertainty& shared) {
  if (radii.Count() == 0) return {};
  const Extremes at = ExtremesOf(radii.deviation_m);
  return {Weighted(radii, Only(radii, at.largest), shared), Weighted(radii, Only(radii, at.smallest), shared)};
}

Iso230_4Value MeanOf(const Radii& radii, const SharedUncertainty& shared) {
  if (radii.Count() == 0) return {};
  return Weighted(radii, VectorXd::Constant(radii.Count(), 1.0 / static_cast<double>(radii.Count())), shared);
}

double Apart_rad(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, units::turn));
}

/// Readings of both directions at the same angle.
Iso230_4Value Hysteresis(const Radii& ccw, const Radii& cw, const SharedUncertainty& shared) {
  constexpr double kSame_rad = 1e-6;
  Iso230_4Value largest;
  for (Index i = 0; i < ccw.Count(); ++i) {
    for (Index j = 0; j < cw.Count(); ++j) {
      if (Apart_rad(ccw.angle_rad[i], cw.angle_rad[j]) > kSame_rad) continue;
      const double apart_m = std::abs(ccw.deviation_m[i] - cw.deviation_m[j]);
      if (apart_m <= largest.value_m) continue;
      largest = shared.IsKnown() ? With(apart_m, ccw.Own(i) + cw.Own(j)) : Iso230_4Value{apart_m};
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
  d.G_ccw = Circular(ccw, shared);
  d.G_cw = Circular(cw, shared);
  const Radial of_ccw = RadialOf(ccw, shared), of_cw = RadialOf(cw, shared);
  d.Fmax_ccw = of_ccw.largest;
  d.Fmin_ccw = of_ccw.smallest;
  d.Fmax_cw = of_cw.largest;
  d.Fmin_cw = of_cw.smallest;
  if (counter.empty() || clockwise.empty()) return d;
  const Radii both = RadiiOf(paths);
  const Radial of_both = RadialOf(both, shared);
  d.G_b = Circular(both, shared);
  d.Fmax_b = of_both.largest;
  d.Fmin_b = of_both.smallest;
  d.D = MeanOf(both, shared);
  d.H = Hysteresis(ccw, cw, shared);
  return d;
}

}  // namespace

std::vector<std::pair<std::string, Iso230_4Value>> NamedValues(const Iso230_4& d) {
  return {{"G_ccw", d.G_ccw},
          {"G_cw", d.G_cw},
          {"G_b", d.G_b},
          {"Fmax_ccw", d.Fmax_ccw},
          {"Fmin_ccw", d.Fmin_ccw},
          {"Fmax_cw", d.Fmax_cw},
          {"Fmin_cw", d.Fmin_cw},
          {"Fmax_b", d.Fmax_b},
          {"Fmin_b", d.Fmin_b},
          {"D", d.D},
          {"H", d.H}};
}

std::vector<Iso230_4> CircularDeviations(const std::vector<CirclePath>& paths, const SharedUncertainty& shared) {
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
