#include "twin/benches/rotary_4dof/estimators/published_motion.h"

#include <cmath>
#include <map>
#include <utility>

namespace twinbench::measure {
namespace {

double CosTheta(const BenchGeometry& geometry) {
  return std::sqrt(1.0 - std::pow(geometry.SinTheta(), 2));
}

/// Eq. 7 asks for the slope of P_Ax + P_Bx against 2 cos(theta) sin(2 ez).
struct Slope {
  int n = 0;
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  void Add(double xi, double yi) {
    ++n;
    x += xi;
    y += yi;
    xx += xi * xi;
    xy += xi * yi;
  }
  double Spread() const { return xx - x * x / n; }
  double Value() const { return (xy - x * y / n) / Spread(); }
};

double SumAx_m(const Reading& r, const BenchGeometry& geometry) {
  return r.mean_V[0] / geometry.sensitivity_V_m[0] + r.mean_V[2] / geometry.sensitivity_V_m[1];
}

}  // namespace

Vector4 PublishedMotion(const Vector4& spots_m, double l1_m, const BenchGeometry& geometry) {
  const double sin_theta = geometry.SinTheta();
  const double cos_theta = CosTheta(geometry);
  const double ax = spots_m[0], ay = spots_m[1], bx = spots_m[2], by = spots_m[3];
  const double h0_m = geometry.SpotFromTarget().z();
  const double ez_p = 0.5 * std::asin((ax + bx) / (2.0 * l1_m * cos_theta));  // (6)
  const double returned_m = l1_m * (sin_theta - sin_theta * std::cos(2 * ez_p) + cos_theta * std::sin(2 * ez_p));
  const double dy_p = (returned_m - bx) * cos_theta / sin_theta;        // (8)
  const double ey_p = std::atan((ay - by) / (2.0 * l1_m * sin_theta));  // (10)
  const double lever_m = 2.0 * h0_m * std::sin(ey_p) * std::tan(ey_p);
  const double ex_p = 0.5 * std::atan((ay + by - lever_m) / (2.0 * l1_m));  // (12)
  return {-ez_p, ex_p, -ey_p, -dy_p};
}

std::optional<double> PublishedDistance(const std::vector<Reading>& readings, const BenchGeometry& geometry) {
  constexpr double kLeastSpread = 1e-12;  // (1 microradian)^2: less is no sweep
  Slope slope;
  for (const Reading& r : readings) {
    const double ez_p = -r.autocollimator_yaw_rad;
    const double sum_m = SumAx_m(r, geometry);
    if (r.phase != Phase::kCalibration || r.status != ReadingStatus::kOk) continue;
    if (std::isfinite(ez_p) && std::isfinite(sum_m)) slope.Add(2 * CosTheta(geometry) * std::sin(2 * ez_p), sum_m);
  }
  if (slope.n < 3 || slope.Spread() < kLeastSpread) return std::nullopt;
  return slope.Value();
}

void RemoveShiftConstants(std::vector<Motion>& motions) {
  std::map<std::pair<Phase, int>, std::pair<double, int>> sums;
  for (const Motion& m : motions) {
    auto& sum = sums[{m.phase, m.setup}];
    if (m.status == ReadingStatus::kOk) sum = {sum.first + m.dy_m, sum.second + 1};
  }
  for (Motion& m : motions) {
    const auto& sum = sums[{m.phase, m.setup}];
    if (m.status == ReadingStatus::kOk) m.dy_m -= sum.first / sum.second;
  }
}

}  // namespace twinbench::measure
