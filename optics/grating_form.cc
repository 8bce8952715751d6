#include "optics/grating_form.h"

namespace twinbench::optics {
namespace {

Eigen::Vector2d MapSlope(const std::optional<HeightMap>& map, double x_m, double z_m) {
  return map ? Interpolate(*map, x_m, z_m).slope : Eigen::Vector2d::Zero();
}

}  // namespace

bool GratingForm::IsPlain() const {
  return sphere_m == 0.0 && astigmatism_m == 0.0 && chirp_per_m == 0.0 && fan_rad_m == 0.0 && !flatness_um &&
         !ruling_um;
}

Eigen::Vector2d GratingForm::HeightSlope(double x_m, double z_m) const {
  const double a2 = half_width_m * half_width_m;
  const Eigen::Vector2d slope(2.0 * (sphere_m + astigmatism_m) * x_m / a2,
                              2.0 * (sphere_m - astigmatism_m) * z_m / a2);
  return slope + MapSlope(flatness_um, x_m, z_m);
}

Eigen::Vector2d GratingForm::GrooveSlope(double x_m, double z_m) const {
  return Eigen::Vector2d(chirp_per_m * x_m + fan_rad_m * z_m, fan_rad_m * x_m) + MapSlope(ruling_um, x_m, z_m);
}

LocalGrating LocalGratingAt(const GratingForm& form, const Eigen::Vector3d& across, const Eigen::Vector3d& normal,
                            const Eigen::Vector3d& along, double x_m, double z_m) {
  const Eigen::Vector2d h = form.HeightSlope(x_m, z_m), s = form.GrooveSlope(x_m, z_m);
  // Grooves are where x - s is a whole number of distances: its gradient lies across them, in the front.
  const double by_x = 1.0 - s.x(), by_z = -s.y();
  return {(normal - h.x() * across - h.y() * along).normalized(),
          by_x * across + by_z * along + (h.x() * by_x + h.y() * by_z) * normal};
}

}  // namespace twinbench::optics
