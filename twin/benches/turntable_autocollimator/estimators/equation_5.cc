#include "twin/benches/turntable_autocollimator/estimators/equation_5.h"

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "twin/core/errors.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kLeastDifference = 3.0;  // of the tilts, in its standard uncertainty

/// Mean reading of a set-up at one position.
struct Cell {
  double x_rad = 0.0;
  double y_rad = 0.0;
  int readings = 0;
};

int FindLabel(const StopGrid& grid, int label) {
  for (std::size_t s = 0; s < grid.setups.size(); ++s) {
    if (grid.setups[s].label == label) return static_cast<int>(s);
  }
  throw InputError("mounting " + std::to_string(label), "no usable measuring position", "two mountings of different tilt");
}

std::vector<Cell> MeanCircle(const std::vector<TurntableStop>& stops, const StopGrid& grid, int setup) {
  std::vector<Cell> circle(static_cast<std::size_t>(grid.n));
  for (const GridStop& g : grid.stops) {
    if (g.setup != setup) continue;
    Cell& cell = circle[static_cast<std::size_t>(g.position)];
    cell.x_rad += stops[g.stop].x_rad;
    cell.y_rad += stops[g.stop].y_rad;
    ++cell.readings;
  }
  for (Cell& cell : circle) {
    cell.x_rad /= cell.readings;  // 0 / 0, NaN, where nothing was read
    cell.y_rad /= cell.readings;
  }
  return circle;
}

/// First position that both set-ups read.
std::size_t FindStart(const std::vector<Cell>& a, const std::vector<Cell>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].readings > 0 && b[i].readings > 0) return i;
  }
  throw InputError("readings", "no position that both mountings read", "two full circles");
}

/// Variance of one zero-based mean reading in units of one reading's.
double VarianceFactor(const Cell& cell, const Cell& start) {
  return 1.0 / cell.readings + 1.0 / start.readings;
}

PointwiseError Solve(const Cell& a, const Cell& b, const Cell& start_a, const Cell& start_b,
                     const AutocollimatorNoise& noise) {
  PointwiseError point;
  const double x0 = a.x_rad - start_a.x_rad, y0 = a.y_rad - start_a.y_rad;
  const double x1 = b.x_rad - start_b.x_rad, y1 = b.y_rad - start_b.y_rad;
  if (!std::isfinite(x0 + x1)) return point;
  const double difference = y1 - y0;
  const double of_0 = y1 / difference, of_1 = -y0 / difference;  // d value / d x
  const double slope = (x1 - x0) / difference;                   // tan of the roll, as seen at this position alone
  point.value_rad = of_0 * x0 + of_1 * x1;
  point.magnification = std::hypot(of_0, of_1);
  const double u_one_rad = std::hypot(noise.u_x_rad, slope * noise.u_y_rad);
  const double factor_0 = VarianceFactor(a, start_a), factor_1 = VarianceFactor(b, start_b);
  point.u_rad = u_one_rad * std::sqrt(of_0 * of_0 * factor_0 + of_1 * of_1 * factor_1);
  const bool is_noise = std::abs(difference) < kLeastDifference * noise.u_y_rad * std::sqrt(factor_0 + factor_1);
  point.status = point.magnification < kPoleMagnification && !is_noise ? PointStatus::kOk : PointStatus::kNearPole;
  return point;
}

/// What the equation leaves out: its value is that about the axis, over cos g.
void AddLeftOut(const std::vector<Cell>& a, const std::vector<Cell>& b, std::size_t start, std::vector<PointwiseError>& points) {
  double across = 0.0, along = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].status == PointStatus::kMissing) continue;
    const double dx = b[i].x_rad - b[start].x_rad - a[i].x_rad + a[start].x_rad, dy = b[i].y_rad - b[start].y_rad - a[i].y_rad + a[start].y_rad;
    across += dx * dy;
    along += dy * dy;
  }
  const double share = 1.0 - 1.0 / std::hypot(1.0, across / along);  // 1 - cos g
  for (PointwiseError& point : points) point.u_rad = std::hypot(point.u_rad, share * point.value_rad);
}

}  // namespace

std::vector<PointwiseError> SolveEquation5(const std::vector<TurntableStop>& stops, int first, int second,
                                           const AutocollimatorNoise& noise, int positions) {
  const StopGrid grid = FindGrid(stops, positions);
  const int a = FindLabel(grid, first), b = FindLabel(grid, second);
  const SetUp &setup_a = grid.setups[static_cast<std::size_t>(a)],
              &setup_b = grid.setups[static_cast<std::size_t>(b)];
  if (setup_a.row != setup_b.row || setup_a.shift != setup_b.shift) {
    throw InputError("mounting " + std::to_string(second), "another shift than mounting " + std::to_string(first),
                     "the same teeth at the same positions, only the tilt changed");
  }
  const std::vector<Cell> circle_a = MeanCircle(stops, grid, a), circle_b = MeanCircle(stops, grid, b);
  const std::size_t start = FindStart(circle_a, circle_b);
  std::vector<PointwiseError> points(circle_a.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Solve(circle_a[i], circle_b[i], circle_a[start], circle_b[start], noise);
    points[i].turntable_rad = grid.Position_rad(static_cast<int>(i));
  }
  AddLeftOut(circle_a, circle_b, start, points);
  points[start].value_rad = points[start].u_rad = 0.0;  // by definition; 0 / 0 by the equation
  return points;
}

}  // namespace twinbench::separate::turntable
