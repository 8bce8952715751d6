#include "optics/window.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace twinbench::optics {

std::pair<Surface, Surface> WindowFaces(const Window& window, const Eigen::Isometry3d& X_LP, double width_m,
                                        double height_m) {
  const double w = width_m + 2.0 * kPackageMargin_m, h = height_m + 2.0 * kPackageMargin_m;
  const Eigen::Isometry3d back = X_LP * Eigen::Translation3d(0.0, 0.0, window.gap_m);
  // The front face rises towards +u, hence a negative turn about v.
  const Eigen::Isometry3d front = back * Eigen::Translation3d(0.0, 0.0, window.thickness_m) *
                                  Eigen::AngleAxisd(-std::atan(window.wedge_rad), Eigen::Vector3d::UnitY());
  return {RectangularPlane(back, w, h), RectangularPlane(front, w, h)};
}

Eigen::Vector3d Reflect(const Eigen::Vector3d& d, const Eigen::Vector3d& normal) {
  return d - 2.0 * d.dot(normal) * normal;
}

Refracted Refract(const Eigen::Vector3d& d, const Eigen::Vector3d& normal, double index_ratio) {
  const double toward = d.dot(normal);
  const Eigen::Vector3d k = index_ratio * (d - toward * normal);
  const double q = 1.0 - k.squaredNorm();
  if (q <= 0.0) return {Reflect(d, normal), true};
  return {k + std::copysign(std::sqrt(q), toward) * normal, false};
}

Etalon Interfere(double reflectance, double phase_rad, const Eigen::Vector2d& phase_gradient_per_m,
                 const Eigen::Matrix2d& cov_m2) {
  const Eigen::Vector2d lever_m = cov_m2 * phase_gradient_per_m;
  const double variance = phase_gradient_per_m.dot(lever_m);
  double sum = 1.0, slope = 0.0, r = reflectance;
  for (int k = 1; r > 1e-14; ++k, r *= reflectance) {
    const double washed_out = 2.0 * r * std::exp(-0.5 * k * k * variance);
    sum += washed_out * std::cos(k * phase_rad);
    slope -= washed_out * k * std::sin(k * phase_rad);
  }
  return {.transmission = (1.0 - reflectance) / (1.0 + reflectance) * sum, .shift_m = lever_m * (slope / sum)};
}

std::pair<double, Eigen::Vector2d> EtalonPhase(const Window& window, double wavelength_m,
                                               const Eigen::Vector3d& d_P, double u_m,
                                               const Eigen::Matrix2d& direction_slopes_per_m) {
  const Eigen::Vector2d inside = d_P.head<2>() / window.index;
  const double cosine = std::sqrt(1.0 - inside.squaredNorm());
  const double turns = 4.0 * std::numbers::pi * window.index / wavelength_m;
  const double thickness = window.thickness_m + window.wedge_rad * u_m;
  const Eigen::Vector2d wedge(turns * cosine * window.wedge_rad, 0.0);
  const Eigen::Vector2d wavefront =
      -turns * thickness / (window.index * cosine) * (direction_slopes_per_m.transpose() * inside);
  return {turns * thickness * cosine, wedge + wavefront};
}

void Validate(const Window& window) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(std::string("window: ") + what);
  };
  require(window.thickness_m > 0.0 && window.gap_m > 0.0, "thickness_m and gap_m must be positive");
  require(window.index >= 1.0, "index must be at least 1");
  require(window.reflectance >= 0.0 && window.reflectance < 1.0, "reflectance must be in [0, 1)");
  require(std::abs(window.wedge_rad) < 0.1, "wedge_rad must be below 0.1");
}

}  // namespace twinbench::optics
