#include "optics/beam.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace twinbench::optics {
namespace {

/// Adds four slopes of equal weight at one position; +-sigma has the variance of the normal distribution.
void AddWithSlopes(BeamNodes& nodes, double x_m, double y_m, double slope, double weight) {
  if (slope == 0.0) {
    nodes.push_back({x_m, y_m, 0.0, 0.0, weight});
    return;
  }
  for (const double sx : {-slope, slope}) {
    for (const double sy : {-slope, slope}) nodes.push_back({x_m, y_m, sx, sy, weight / 4.0});
  }
}

/// Mean of a standard normal within each of m slices of equal probability.
std::vector<double> EqualSlices(int m) {
  const auto quantile = [](double p) {
    double low = -9.0, high = 9.0;
    while (high - low > 1e-13) {
      const double mid = 0.5 * (low + high);
      (0.5 * std::erfc(-mid / std::sqrt(2.0)) < p ? low : high) = mid;
    }
    return low;
  };
  std::vector<double> means;
  const auto density = [](double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); };
  for (int i = 0; i < m; ++i) {
    const double a = i == 0 ? 0.0 : density(quantile(static_cast<double>(i) / m));
    const double b = i == m - 1 ? 0.0 : density(quantile(static_cast<double>(i + 1) / m));
    means.push_back(m * (a - b));
  }
  return means;
}

/// How many pixels of a map go together.
struct Gathered {
  int side, step_x, step_y;  // blocks a side of the picture; pixels a block

  Gathered(const IrradianceMap& map, int max_positions)
      : side(std::max(1, static_cast<int>(std::sqrt(static_cast<double>(max_positions))))),
        step_x((map.width + side - 1) / side),
        step_y((map.height + side - 1) / side) {}
};

struct Block {
  double sum = 0.0, x = 0.0, y = 0.0;
};

}  // namespace

Quadrature GaussHermite(int n) {
  if (n < 1) throw std::invalid_argument("Gauss-Hermite: at least one node");
  // The square roots of 1 ... n - 1 beside the diagonal are all of the matrix (Golub and Welsch); its largest element becomes 1.
  const double scale = std::sqrt(std::max(1.0, n - 1.0));
  const Eigen::VectorXd beside = Eigen::VectorXd::LinSpaced(n, 0.0, n - 1.0).cwiseSqrt().tail(n - 1) / scale;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(Eigen::VectorXd::Zero(n), beside);
  const Eigen::VectorXd node = scale * eigen.eigenvalues();
  Quadrature rule;
  for (int i = 0; i < n; ++i) {
    // The rule is symmetric; averaging mirror pairs removes the solver's rounding from every odd moment.
    rule.node.push_back(0.5 * (node(i) - node(n - 1 - i)));
    rule.weight.push_back(
        0.5 * (std::pow(eigen.eigenvectors()(0, i), 2) + std::pow(eigen.eigenvectors()(0, n - 1 - i), 2)));
  }
  return rule;
}

BeamNodes GaussianBundle(double radius_m, double divergence_rad, int n) {
  const Quadrature rule = GaussHermite(n);
  const double sx = radius_m / 2.0, st = divergence_rad / 2.0;
  BeamNodes nodes;
  const auto each = [&rule](auto visit) {
    for (std::size_t i = 0; i < rule.node.size(); ++i) visit(rule.node[i], rule.weight[i]);
  };
  each([&](double x, double wx) {
    each([&](double y, double wy) {
      each([&](double a, double wa) {
        each([&](double b, double wb) { nodes.push_back({sx * x, sx * y, st * a, st * b, wx * wy * wa * wb}); });
      });
    });
  });
  return nodes;
}

BeamNodes DenseBundle(double radius_m, double divergence_rad, int m) {
  const std::vector<double> slices = EqualSlices(m);
  BeamNodes nodes;
  const double weight = 1.0 / (static_cast<double>(m) * m);
  for (const double x : slices) {
    for (const double y : slices) {
      AddWithSlopes(nodes, x * radius_m / 2.0, y * radius_m / 2.0, divergence_rad / 2.0, weight);
    }
  }
  return nodes;
}

BeamNodes ProfileBundle(const IrradianceMap& map, double divergence_rad, int max_positions) {
  const auto [side, step_x, step_y] = Gathered(map, max_positions);
  std::vector<Block> blocks(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  double total = 0.0;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      Block& block = blocks[static_cast<std::size_t>(row / step_y * side + column / step_x)];
      const double value = map.At(row, column);
      block.sum += value;
      block.x += value * map.U(column);
      block.y += value * map.V(row);
      total += value;
    }
  }
  if (!(total > 0.0)) throw std::invalid_argument("beam profile: the map holds no light");
  BeamNodes nodes;
  for (const Block& block : blocks) {
    if (!(block.sum > 0.0)) continue;
    AddWithSlopes(nodes, block.x / block.sum, block.y / block.sum, divergence_rad / 2.0, block.sum / total);
  }
  return nodes;
}

Eigen::Vector2d ProfileBlock_m(const IrradianceMap& map, int max_positions) {
  const Gathered gathered(map, max_positions);
  return map.pitch_m * Eigen::Vector2d(gathered.step_x, gathered.step_y);
}

BeamAxes AxesAcross(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d x = direction.cross(Eigen::Vector3d::UnitZ()).normalized();
  return {x, x.cross(direction)};
}

Ray NodeRay(const Ray& chief, const BeamAxes& axes, const BeamNode& node) {
  return {chief.origin_m + node.x_m * axes.x + node.y_m * axes.y,
          (chief.direction + node.slope_x * axes.x + node.slope_y * axes.y).normalized()};
}

}  // namespace twinbench::optics
