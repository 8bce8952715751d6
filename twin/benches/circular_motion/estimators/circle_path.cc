#include "twin/benches/circular_motion/estimators/circle_path.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>

#include "twin/core/linear_algebra.h"

namespace twinbench::separate::circular {
namespace {

std::vector<CirclePath> Paths(const std::vector<CirclePoint>& points,
                              const std::function<PathPoint(const CirclePoint&)>& path_point) {
  std::vector<CirclePath> paths;
  for (const CirclePoint& p : points) {
    if (paths.empty() || paths.back().setup != p.setup || paths.back().pass != p.pass)
      paths.push_back({p.setup, p.pass, p.direction, p.is_bar, p.radius_m, p.feed_m_s, {}, p.has_angle, p.is_drive});
    paths.back().points.push_back(path_point(p));
  }
  return paths;
}

/// Where the bar of a set-up measured its centre.
std::vector<CirclePoint> CentrePoints(const std::vector<CirclePoint>& points, int setup) {
  double slowest_m_s = std::numeric_limits<double>::infinity();
  for (const CirclePoint& p : points) {
    if (p.setup == setup && p.feed_m_s > 0.0) slowest_m_s = std::min(slowest_m_s, p.feed_m_s);
  }
  std::vector<CirclePoint> chosen;
  std::ranges::copy_if(points, std::back_inserter(chosen), [&](const CirclePoint& p) {
    return p.setup == setup && (p.feed_m_s == slowest_m_s || !std::isfinite(slowest_m_s));
  });
  return chosen;
}

/// Bar minus grid at one angle.
struct Difference {
  double angle_rad, radial_m, tangential_m;
};

bool SameCircle(const CirclePath& a, const CirclePath& b) {
  constexpr double kSame = 1e-9;
  return a.has_angle && b.has_angle && std::abs(a.radius_m - b.radius_m) < kSame && std::abs(a.feed_m_s - b.feed_m_s) < kSame &&
         a.direction == b.direction && a.points.size() == b.points.size();
}

std::vector<Difference> Differences(const std::vector<CirclePath>& paths) {
  std::vector<Difference> all;
  for (const CirclePath& bar : paths) {
    for (const CirclePath& grid : paths) {
      if (!bar.is_bar || grid.is_bar || !SameCircle(bar, grid)) continue;
      for (std::size_t i = 0; i < bar.points.size(); ++i) {
        const PathPoint &a = bar.points[i], &b = grid.points[i];
        all.push_back({a.commanded_rad, a.Radial_m() - b.Radial_m(), a.Tangential_m() - b.Tangential_m()});
      }
    }
  }
  return all;
}

/// Of one reading, along the radius and across it. An angle that is off by d leaves R d^2 / 2 along the radius, whose rms is sqrt(3) R u^2 / 2.
Eigen::Vector2d OwnUncertainty_m(const CirclePoint& p) {
  const double bent_m = p.is_bar && p.has_angle ? 0.5 * std::sqrt(3.0) * p.u_tangential_m * p.u_tangential_m / p.radius_m : 0.0;
  return {std::hypot(p.u_radial_m, bent_m), p.u_tangential_m};
}

}  // namespace

std::vector<CirclePath> RigorousPaths(const std::vector<CirclePoint>& points, const CircleFit& fit,
                                      const CircleConstants& known) {
  return Paths(points, [&](const CirclePoint& p) {
    return PathPoint{p.commanded_rad,
                     Deviation_m(p, fit.errors, fit.MountingOf(p.setup), known),
                     OwnUncertainty_m(p),
                     p.of_machine,
                     p.of_steps,
                     SlopeOfDeviation(p, fit, known),
                     p.radial_m};
  });
}

std::vector<CirclePath> PublishedPaths(const std::vector<CirclePoint>& points) {
  std::vector<CirclePoint> of_bar;
  std::ranges::copy_if(points, std::back_inserter(of_bar), &CirclePoint::is_bar);
  std::map<int, Eigen::Vector2d> offset_m;
  for (const CirclePoint& p : of_bar) {
    if (!offset_m.contains(p.setup)) offset_m[p.setup] = PublishedOffsetOf_m(of_bar, p.setup);
  }
  return Paths(of_bar, [&](const CirclePoint& p) {
    PathPoint point;
    point.commanded_rad = p.commanded_rad;
    point.d_m = PublishedDeviation_m(p, offset_m.at(p.setup));
    return point;
  });
}

Eigen::Vector2d PublishedOffsetOf_m(const std::vector<CirclePoint>& points, int setup) {
  return PublishedOffset_m(CentrePoints(points, setup));
}

Eigen::Vector2d Uncertainty_m(const PathPoint& point, const SharedUncertainty& shared) {
  const double c = std::cos(point.commanded_rad), s = std::sin(point.commanded_rad);
  const Eigen::Vector2d own(std::hypot(c * point.u_own_m.x(), s * point.u_own_m.y()),
                            std::hypot(s * point.u_own_m.x(), c * point.u_own_m.y()));
  if (point.slope.cols() == 0) return own;
  const Eigen::Array2d variance(shared.Variance(point.slope.row(0)), shared.Variance(point.slope.row(1)));
  return (own.array().square() + variance).sqrt();
}

double RadialUncertainty_m(const PathPoint& point, const SharedUncertainty& shared) {
  if (point.slope.cols() == 0) return point.u_own_m.x();
  const Eigen::Vector2d radial(std::cos(point.commanded_rad), std::sin(point.commanded_rad));
  return std::sqrt(point.u_own_m.x() * point.u_own_m.x() + shared.Variance(point.slope.transpose() * radial));
}

BarAgainstGrid CompareWithGrid(const std::vector<CirclePath>& paths) {
  const std::vector<Difference> all = Differences(paths);
  if (all.empty()) return {};
  // Free: centre (x, y), zero and mean radius.
  Eigen::MatrixXd free(2 * std::ssize(all), 4);
  Eigen::VectorXd difference_m(free.rows());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(i);
    const double c = std::cos(all[i].angle_rad), s = std::sin(all[i].angle_rad);
    free.row(row) << c, s, 0.0, 1.0;
    free.row(row + 1) << -s, c, 1.0, 0.0;
    difference_m.segment<2>(row) << all[i].radial_m, all[i].tangential_m;
  }
  const Eigen::VectorXd left_m = difference_m - free * SolveLeastSquares(free, difference_m);
  const auto largest_m = [&](int first) { return left_m(Eigen::seq(first, Eigen::last, 2)).cwiseAbs().maxCoeff(); };
  return {static_cast<int>(all.size()), largest_m(0), largest_m(1)};
}

}  // namespace twinbench::separate::circular
