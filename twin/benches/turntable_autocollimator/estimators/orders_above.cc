#include "twin/benches/turntable_autocollimator/estimators/orders_above.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kStandsOut = 16.0;  // times the mean of two degrees of freedom: one of 9 million by chance
constexpr double kSeen = 0.05;       // of a wave, as squares: of less the readings say nothing
constexpr int kFewest = 6;

/// What the fit leaves of both waves of an order.
struct Waves {
  int order = 0;
  Eigen::MatrixXd rest;      // one row a reading
  Eigen::Matrix2d cofactor;  // inverse of their products
};

std::vector<Waves> WavesOf(const Eigen::MatrixXd& fitted, const Eigen::VectorXd& angle_rad, int first, int last) {
  const Eigen::Index orders = last - first + 1, count = angle_rad.size();
  Eigen::MatrixXd all(count, 2 * orders);
  for (Eigen::Index k = 0; k < orders; ++k) {
    const Eigen::ArrayXd turned = static_cast<double>(first + k) * angle_rad.array();
    all.col(2 * k) = turned.cos();
    all.col(2 * k + 1) = turned.sin();
  }
  all -= fitted * (fitted.transpose() * all);
  std::vector<Waves> waves;
  for (Eigen::Index k = 0; k < orders; ++k) {
    const Eigen::MatrixXd rest = all.middleCols<2>(2 * k);
    const Eigen::Matrix2d products = rest.transpose() * rest;
    const double seen = products.determinant() / products.trace();  // no more than the lesser eigenvalue
    if (seen > kSeen * 0.5 * static_cast<double>(count)) waves.push_back({first + static_cast<int>(k), rest, products.inverse()});
  }
  return waves;
}

}  // namespace

OrdersAbove FindOrdersAbove(const Eigen::MatrixXd& fitted, const Eigen::VectorXd& angle_rad, Eigen::VectorXd residual_rad,
                            int first, int last) {
  OrdersAbove found;
  if (last - first + 1 < kFewest) return found;
  const std::vector<Waves> waves = WavesOf(fitted, angle_rad, first, last);
  while (std::ssize(waves) - std::ssize(found.orders) >= kFewest) {
    std::vector<double> squares;
    for (const Waves& one : waves) {
      const Eigen::Vector2d product = one.rest.transpose() * residual_rad;
      squares.push_back(product.dot(one.cofactor * product));
    }
    const auto largest = std::ranges::max_element(squares);
    const double by_chance = Median(squares) / std::log(2.0);  // their mean, of white residuals
    if (!(*largest > kStandsOut * by_chance)) break;
    const Waves& out = waves[static_cast<std::size_t>(largest - squares.begin())];
    const Eigen::Vector2d cos_sin_rad = out.cofactor * (out.rest.transpose() * residual_rad);
    residual_rad -= out.rest * cos_sin_rad;
    found.orders.push_back(out.order);
    found.variance_rad2 += 0.5 * cos_sin_rad.squaredNorm();
  }
  std::ranges::sort(found.orders);
  found.orders.erase(std::unique(found.orders.begin(), found.orders.end()), found.orders.end());
  return found;
}

}  // namespace twinbench::separate::turntable
