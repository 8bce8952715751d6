#include "optics/quadrant_detector.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace twinbench::optics {
namespace {

/// Probability that a standard normal variable exceeds z.
double Above(double z) {
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

/// What correlation adds to the product of P(x > h) and P(y > k).
double ByCorrelation(double h, double k, double correlation) {
  const auto density = [h, k](double angle) {
    const double s = std::sin(angle), c2 = 1.0 - s * s;
    return std::exp(-0.5 * (h * h + k * k - 2.0 * h * k * s) / c2);
  };
  constexpr unsigned kPoints = 30;
  return boost::math::quadrature::gauss<double, kPoints>::integrate(density, 0.0, std::asin(correlation)) /
         (2.0 * std::numbers::pi);
}

double StandardDeviation(double variance_m2, double gap_m) {
  // Never 0: a point beside the gap then lies wholly in its quadrant.
  return std::max(std::sqrt(std::max(variance_m2, 0.0)), 1e-9 * gap_m + 1e-15);
}

}  // namespace

QuadrantPowers OnQuadrants(const Spot& spot, double gap_m) {
  const double sigma_u = StandardDeviation(spot.cov_m2(0, 0), gap_m);
  const double sigma_v = StandardDeviation(spot.cov_m2(1, 1), gap_m);
  const double correlation = spot.cov_m2(0, 1) / (sigma_u * sigma_v);
  const auto share = [&](double sign_u, double sign_v) {
    const double h = (0.5 * gap_m - sign_u * spot.u_m) / sigma_u, k = (0.5 * gap_m - sign_v * spot.v_m) / sigma_v;
    const double apart = Above(h) * Above(k);
    return correlation == 0.0 ? apart : apart + ByCorrelation(h, k, sign_u * sign_v * correlation);
  };
  const double power = spot.power_W;
  return {power * share(1.0, 1.0), power * share(-1.0, 1.0), power * share(-1.0, -1.0), power * share(1.0, -1.0)};
}

}  // namespace twinbench::optics
