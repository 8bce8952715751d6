#include "twin/benches/circular_motion/estimators/published.h"

namespace twinbench::separate::circular {
namespace {

double Encoder_rad(const CirclePoint& p) {
  return p.has_angle ? p.commanded_rad + p.tangential_m / p.radius_m : p.commanded_rad;
}

}  // namespace

Eigen::Vector2d PublishedOffset_m(const std::vector<CirclePoint>& points) {
  double cc = 0.0, cs = 0.0, ss = 0.0, rc_m = 0.0, rs_m = 0.0;
  for (const CirclePoint& p : points) {
    const double c = std::cos(Encoder_rad(p)), s = std::sin(Encoder_rad(p));
    cc += c * c;
    cs += c * s;
    ss += s * s;
    rc_m += p.radial_m * c;
    rs_m += p.radial_m * s;
  }
  const double determinant = cc * ss - cs * cs;
  return Eigen::Vector2d(rc_m * ss - rs_m * cs, rs_m * cc - rc_m * cs) / determinant;
}

Eigen::Vector2d PublishedDeviation_m(const CirclePoint& p, const Eigen::Vector2d& offset_m) {
  const Eigen::Vector2d along(std::cos(Encoder_rad(p)), std::sin(Encoder_rad(p)));
  return (p.radius_m + p.radial_m - offset_m.dot(along)) * along - p.Commanded_m();
}

}  // namespace twinbench::separate::circular
