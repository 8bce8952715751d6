#include "twin/benches/circular_motion/estimators/radii.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/linear_algebra.h"

namespace twinbench::separate::circular {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// How many readings each of a path stands for by the angle up to half-way to its neighbours. Of a turn that is not quite closed, or of which
/// a part was read more often than the rest, the centre is pulled otherwise; an arc has no other side, and an even turn needs none.
VectorXd StandsFor(const CirclePath& path) {
  constexpr double kEven_rad = 1.0 * units::deg, kArc_rad = 30.0 * units::deg;
  const Index count = std::ssize(path.points);
  std::vector<std::pair<double, Index>> order;
  for (Index i = 0; i < count; ++i) order.emplace_back(WithinTurn_rad(path.points[static_cast<std::size_t>(i)].commanded_rad), i);
  std::ranges::sort(order);
  VectorXd angle_rad = VectorXd::Zero(count);
  double widest_rad = 0.0, least_ahead_rad = 0.0, most_ahead_rad = 0.0;  // ahead: of where as many even readings would be
  const double even_rad = units::turn / static_cast<double>(std::max<Index>(count, 1));
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool closes = k + 1 == order.size();
    const auto& [next_rad, next] = order[closes ? 0 : k + 1];
    const double gap_rad = next_rad - order[k].first + (closes ? units::turn : 0.0);
    const double ahead_rad = order[k].first - order[0].first - static_cast<double>(k) * even_rad;
    widest_rad = std::max(widest_rad, gap_rad);
    least_ahead_rad = std::min(least_ahead_rad, ahead_rad);
    most_ahead_rad = std::max(most_ahead_rad, ahead_rad);
    angle_rad[order[k].second] += 0.5 * gap_rad;
    angle_rad[next] += 0.5 * gap_rad;
  }
  const bool is_even = most_ahead_rad - least_ahead_rad < kEven_rad;
  if (is_even || widest_rad > kArc_rad) return VectorXd::Ones(count);
  return angle_rad / even_rad;
}

}  // namespace

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
  radii.rounded_with.resize(points.size());
  radii.stands_for.resize(count);
  Index first = 0;
  for (const CirclePath* path : paths) {
    radii.stands_for.segment(first, std::ssize(path->points)) = StandsFor(*path);
    first += std::ssize(path->points);
  }
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
    const bool same = i > 0 && point.shown_m == points[static_cast<std::size_t>(i - 1)]->shown_m;
    radii.rounded_with[static_cast<std::size_t>(i)] = same ? radii.rounded_with[static_cast<std::size_t>(i - 1)] : i;
    if (radii.slope.cols() > 0) radii.slope.row(i) = c * point.slope.row(0) + s * point.slope.row(1);
  }
  return radii;
}

double WithinTurn_rad(double angle_rad) {
  const double turned_rad = std::fmod(angle_rad, units::turn);
  return turned_rad < 0.0 ? turned_rad + units::turn : turned_rad;
}

Eigen::MatrixXd CircleOf(const Radii& radii) {
  constexpr int kHighest = 3;
  const int highest = radii.IsUneven() ? kHighest : 1;
  Eigen::MatrixXd circle(radii.Count(), 2 * highest + 1);
  circle.leftCols(3) << radii.angle_rad.array().cos(), radii.angle_rad.array().sin(), VectorXd::Ones(radii.Count());
  for (int order = 2; order <= highest; ++order)
    circle.middleCols(2 * order - 1, 2) << (order * radii.angle_rad).array().cos(), (order * radii.angle_rad).array().sin();
  return circle;
}

Radii AboutOwnCentre(Radii radii) {
  const Eigen::MatrixXd circle = CircleOf(radii);
  const Eigen::DiagonalMatrix<double, Eigen::Dynamic> weight(radii.stands_for.cwiseSqrt());
  const Eigen::MatrixXd weighted = weight * circle;
  radii.deviation_m -= circle.leftCols(2) * SolveLeastSquares(weighted, weight * radii.deviation_m).topRows(2);
  if (radii.slope.cols() > 0) radii.slope -= circle.leftCols(2) * SolveLeastSquares(weighted, weight * radii.slope).topRows(2);
  return radii;
}

}  // namespace twinbench::separate::circular
