#include "twin/benches/rotary_4dof/diagnosis/published_equations.h"

#include <cmath>

namespace twinbench::diagnose::rotary {

using measure::Vector4;

Vector4 PublishedSpots_m(const measure::BenchGeometry& geometry, const Vector4& motion) {
  const double sine = geometry.SinTheta(), cosine = std::sqrt(1.0 - sine * sine);
  const double ez_p = -motion[0], ex_p = motion[1], ey_p = -motion[2], dy_p_m = -motion[3];
  const double lever_m = geometry.SpotFromTarget().z() * std::sin(ey_p) * std::tan(ey_p);
  Vector4 spots_m;
  for (int p = 0; p < 2; ++p) {
    const double side = p == 0 ? 1.0 : -1.0, l1_m = geometry.psd_distance_m[static_cast<std::size_t>(p)];
    const double second_order_m = l1_m * sine * (1.0 - std::cos(2.0 * ez_p));
    spots_m[2 * p] = l1_m * cosine * std::sin(2.0 * ez_p) - side * (second_order_m - dy_p_m * sine / cosine);
    spots_m[2 * p + 1] = l1_m * std::tan(2.0 * ex_p) + lever_m + side * l1_m * sine * std::tan(ey_p);
  }
  return spots_m;
}

Eigen::Matrix4d PublishedSlopes(const measure::BenchGeometry& geometry, const Vector4& motion) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix4d slopes;
  for (int i = 0; i < 4; ++i) {
    const Vector4 step = kStep * Vector4::Unit(i);
    slopes.col(i) =
        (PublishedSpots_m(geometry, motion + step) - PublishedSpots_m(geometry, motion - step)) / (2.0 * kStep);
  }
  return slopes;
}

}  // namespace twinbench::diagnose::rotary
