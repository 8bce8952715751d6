#include "twin/benches/circular_motion/twin/instruments.h"

#include <Eigen/Geometry>
#include <cmath>

namespace twinbench::sim {
namespace {

/// From ball 1 to ball 2.
Eigen::Vector3d BarVector_m(const BarSettings& bar, const Eigen::Vector2d& p_m) {
  return {bar.offset_m[0] + p_m.x(), bar.offset_m[1] + p_m.y(), bar.height_m};
}

}  // namespace

double BarShown_m(const BarSettings& bar, const Eigen::Vector2d& p_m, double radius_m, double above_K) {
  const Eigen::Vector3d v_m = BarVector_m(bar, p_m);
  const double azimuth_rad = std::atan2(v_m.y(), v_m.x());
  double longer_m = v_m.norm() - (radius_m + bar.length_error_m) * (1.0 + bar.expansion_per_K * above_K);
  for (std::size_t k = 0; k < bar.ball_m.size(); ++k)
    longer_m += bar.ball_m[k] * std::cos((static_cast<double>(k) + 2.0) * (azimuth_rad - bar.ball_azimuth_rad[k]));
  return longer_m * (1.0 + bar.gain_error + bar.cubic_per_m2 * longer_m * longer_m);
}

double EncoderShown_rad(const BarEncoderSettings& encoder, const BarSettings& bar, const Eigen::Vector2d& p_m,
                        double commanded_rad) {
  const Eigen::Matrix3d tilt = (Eigen::AngleAxisd(encoder.tilt_rad[1], Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(encoder.tilt_rad[0], Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Eigen::Vector3d v_m = tilt.transpose() * BarVector_m(bar, p_m);
  const double azimuth_rad = std::atan2(v_m.y(), v_m.x());
  const double shown_rad =
      azimuth_rad + encoder.eccentricity_rad * std::sin(azimuth_rad - encoder.eccentricity_azimuth_rad) +
      encoder.ellipticity_rad * std::sin(2.0 * (azimuth_rad - encoder.ellipticity_azimuth_rad)) + encoder.zero_rad;
  return commanded_rad + std::remainder(shown_rad - commanded_rad, units::turn);
}

Eigen::Vector2d GridShown_m(const GridSettings& grid, const Eigen::Vector2d& p_m) {
  const Eigen::Vector2d plate_m((1.0 + grid.scale[0]) * p_m.x() - grid.shear_rad * p_m.y(),
                                (1.0 + grid.scale[1]) * p_m.y());
  Eigen::Vector2d shown_m = Eigen::Rotation2Dd(grid.rotation_rad) * plate_m;
  shown_m += Eigen::Vector2d(grid.offset_m[0], grid.offset_m[1]);
  return shown_m + (grid.sde_m * (units::turn / grid.period_m * shown_m).array().sin()).matrix();
}

}  // namespace twinbench::sim
