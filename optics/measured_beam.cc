#include "optics/measured_beam.h"

#include <cmath>
#include <utility>

namespace twinbench::optics {
namespace {

/// A pixel's light behind a window whose faces interfere.
PowerPatch ThroughEtalon(const BeamOnDetector& beam, const Landing& landing, const Eigen::Vector2d& half_m,
                         PowerPatch patch) {
  const Window& window = *beam.psd.window;
  const Eigen::Vector3d direction_P = beam.X_LP.linear().transpose() * landing.direction;
  const auto [phase, gradient] =
      EtalonPhase(window, beam.wavelength_m, direction_P, patch.u_m, Eigen::Matrix2d::Zero());
  const Eigen::Matrix2d cov_m2 = (half_m.array().square() / 3.0).matrix().asDiagonal();
  const Etalon etalon = Interfere(window.reflectance, phase, gradient, cov_m2);
  // Both faces were passed with 1 - R already.
  patch.power_W *= etalon.transmission / std::pow(1.0 - window.reflectance, 2);
  patch.u_m += etalon.shift_m.x();
  patch.v_m += etalon.shift_m.y();
  return patch;
}

}  // namespace

Eigen::Vector2d HalfPixelOn(const BeamOnDetector& beam) {
  const BeamAxes axes = AxesAcross(beam.incident);
  const Eigen::Vector3d facing = beam.X_LP.linear().col(2);
  const auto projected = [&](const Eigen::Vector3d& across) -> Eigen::Vector2d {
    const Eigen::Vector3d on_grating =
        across - across.dot(beam.grating_normal) / beam.incident.dot(beam.grating_normal) * beam.incident;
    const Eigen::Vector3d on_plane = on_grating - on_grating.dot(facing) / beam.order.dot(facing) * beam.order;
    return beam.X_LP.linear().leftCols<2>().transpose() * on_plane;
  };
  const Eigen::Vector2d x = beam.pixel_m.x() * projected(axes.x), y = beam.pixel_m.y() * projected(axes.y);
  return 0.5 * (x.array().square() + y.array().square()).sqrt();
}

MapMaker::MapMaker(const BeamOnDetector& beam, std::size_t rays, double power_W)
    : beam_(beam), power_W_(power_W), interferes_(beam.psd.window && beam.psd.window->coherent) {
  map_.half_m = HalfPixelOn(beam);
  map_.patches.reserve(rays);
}

void MapMaker::Add(double weight, const Landing& landing) {
  arrived_ += weight;
  const double absorbed = landing.transmission * (1.0 - beam_.psd.silicon_reflectance);
  const PowerPatch patch{landing.u_m, landing.v_m, power_W_ * weight * absorbed};
  map_.patches.push_back(interferes_ ? ThroughEtalon(beam_, landing, map_.half_m, patch) : patch);
}

PowerMap MapMaker::Take() {
  map_.lost_share = 1.0 - arrived_;
  return std::move(map_);
}

}  // namespace twinbench::optics
