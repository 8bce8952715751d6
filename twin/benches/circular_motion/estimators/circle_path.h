#pragma once

#include <vector>

#include "twin/benches/circular_motion/estimators/published.h"
#include "twin/benches/circular_motion/estimators/rigorous.h"

namespace twinbench::separate::circular {

/// Where the spindle was at one reading, against where it was told to be.
struct PathPoint {
  double commanded_rad = kNaN;
  Eigen::Vector2d d_m{kNaN, kNaN};      // actual minus commanded, x and y; along the radius where that is all there is
  Eigen::Vector2d u_own_m{kNaN, kNaN};  // standard uncertainty of radius and tangent that is this reading's own
  Eigen::Vector2d of_machine{0.0, 0.0}, of_steps{0.0, 0.0};  // shares of its squares (CirclePoint)
  Eigen::Matrix2Xd slope = {};          // d_m by the unknowns of the fit; empty: none were fitted
  double shown_m = kNaN;                // radial deviation as the instrument showed it

  double Radial_m() const { return std::cos(commanded_rad) * d_m.x() + std::sin(commanded_rad) * d_m.y(); }
  double Tangential_m() const { return std::cos(commanded_rad) * d_m.y() - std::sin(commanded_rad) * d_m.x(); }
};

/// One pass of one set-up.
struct CirclePath {
  int setup = 0, pass = 0, direction = 1;
  bool is_bar = true;
  double radius_m = kNaN, feed_m_s = kNaN;
  std::vector<PathPoint> points;
  bool has_angle = true;  // false: of the radius alone
  bool is_drive = false;
};

/// By the vector form: set-up and instrument taken out as they were fitted.
std::vector<CirclePath> RigorousPaths(const std::vector<CirclePoint>& points, const CircleFit& fit,
                                      const CircleConstants& known);

/// As the paper has it: of the bar only, the centre from the sweeps at the lowest feed of its set-up (or the stops,
/// if it has none). Without uncertainties.
std::vector<CirclePath> PublishedPaths(const std::vector<CirclePoint>& points);

/// That centre.
Eigen::Vector2d PublishedOffsetOf_m(const std::vector<CirclePoint>& points, int setup);

/// Standard uncertainty of x and y of a point.
Eigen::Vector2d Uncertainty_m(const PathPoint& point, const SharedUncertainty& shared);

/// Standard uncertainty of its radial deviation.
double RadialUncertainty_m(const PathPoint& point, const SharedUncertainty& shared);

/// Bar minus grid at the same radius, feed, direction and angle, with centre, zero and mean radius taken out of the
/// difference.
struct BarAgainstGrid {
  int pairs = 0;
  double radial_max_m = kNaN, tangential_max_m = kNaN;
};
BarAgainstGrid CompareWithGrid(const std::vector<CirclePath>& paths);

}  // namespace twinbench::separate::circular
