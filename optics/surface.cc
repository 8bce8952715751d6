#include "optics/surface.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "optics/kernels.h"

namespace twinbench::optics {

void RayBatch::Add(const Ray& ray) {
  ox.push_back(ray.origin_m.x());
  oy.push_back(ray.origin_m.y());
  oz.push_back(ray.origin_m.z());
  dx.push_back(ray.direction.x());
  dy.push_back(ray.direction.y());
  dz.push_back(ray.direction.z());
}

void RayBatch::Resize(std::size_t size) {
  for (Column<double>* array : {&ox, &oy, &oz, &dx, &dy, &dz}) array->resize(size);
}

void RayBatch::Set(std::size_t i, const Ray& ray) {
  ox[i] = ray.origin_m.x();
  oy[i] = ray.origin_m.y();
  oz[i] = ray.origin_m.z();
  dx[i] = ray.direction.x();
  dy[i] = ray.direction.y();
  dz[i] = ray.direction.z();
}

void HitBatch::Resize(std::size_t size) {
  surface.resize(size);
  t_m.resize(size);
  x_m.resize(size);
  y_m.resize(size);
}

void HitBatch::Clear(std::size_t begin, std::size_t n) {
  std::fill_n(surface.data() + begin, n, kNothing);
  std::fill_n(t_m.data() + begin, n, std::numeric_limits<double>::infinity());
}

void HitBatch::Reset(std::size_t size) {
  Resize(size);
  Clear(0, size);
}

Surface RectangularPlane(const Eigen::Isometry3d& X_WS, double width_m, double height_m) {
  return {.X_WS = X_WS, .half_x_m = width_m / 2.0, .half_y_m = height_m / 2.0};
}

Surface CircularPlane(const Eigen::Isometry3d& X_WS, double radius_m) {
  return {.X_WS = X_WS, .half_x_m = radius_m, .half_y_m = radius_m, .radius_m = radius_m};
}

Surface Sphere(const Eigen::Isometry3d& X_WS, double curvature_radius_m, double radius_m) {
  Surface sphere = CircularPlane(X_WS, radius_m);
  sphere.curvature_per_m = 1.0 / curvature_radius_m;
  return sphere;
}

Surface Paraboloid(const Eigen::Isometry3d& X_WS, double focal_length_m, double radius_m) {
  Surface paraboloid = CircularPlane(X_WS, radius_m);
  paraboloid.curvature_per_m = 0.5 / focal_length_m;
  paraboloid.conic = -1.0;
  return paraboloid;
}

double Sag(const Surface& s, double x_m, double y_m) {
  const double r2 = x_m * x_m + y_m * y_m;
  const double c = s.curvature_per_m;
  return c * r2 / (1.0 + std::sqrt(1.0 - (1.0 + s.conic) * c * c * r2));
}

Eigen::Vector3d Normal(const Surface& s, double x_m, double y_m) {
  const double c = s.curvature_per_m;
  const double slope = 1.0 - c * (1.0 + s.conic) * Sag(s, x_m, y_m);
  return s.X_WS.linear() * Eigen::Vector3d(-c * x_m, -c * y_m, slope).normalized();
}

Eigen::Vector3d Point(const Surface& s, double x_m, double y_m) {
  return s.X_WS * Eigen::Vector3d(x_m, y_m, Sag(s, x_m, y_m));
}

Frame MakeFrame(const Surface& s) {
  const auto& o = s.X_WS.translation();
  const auto& r = s.X_WS.linear();
  return {o.x(),
          o.y(),
          o.z(),
          r(0, 0),
          r(1, 0),
          r(2, 0),
          r(0, 1),
          r(1, 1),
          r(2, 1),
          r(0, 2),
          r(1, 2),
          r(2, 2),
          s.curvature_per_m,
          1.0 + s.conic,
          s.half_x_m,
          s.half_y_m,
          s.radius_m * s.radius_m};
}

SurfaceHit Meet(const Surface& surface, const Ray& ray, double t_min_m) {
  return Meet(MakeFrame(surface), ray, t_min_m);
}

NearestHit Nearest(std::span<const Frame> frames, const Ray& ray, double t_min_m) {
  NearestHit nearest;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const SurfaceHit hit = Meet(frames[i], ray, t_min_m);
    if (hit.t_m < nearest.hit.t_m) nearest = {static_cast<int>(i), hit};
  }
  return nearest;
}

void Validate(const Surface& s) {
  if (!(s.half_x_m > 0.0) || !(s.half_y_m > 0.0) || !(s.radius_m > 0.0)) {
    throw std::invalid_argument("surface: the aperture must have a positive size");
  }
  const Eigen::Matrix3d& r = s.X_WS.linear();
  // 1e-9 rad is 0.0002 arcsec: a pose composed of many rotations stays far below, a scaled one far above.
  if (!((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-9) || r.determinant() < 0.0) {
    throw std::invalid_argument("surface: the pose is not a right-handed rotation");
  }
  const double reach = std::min(s.radius_m, std::hypot(s.half_x_m, s.half_y_m));
  if (!((1.0 + s.conic) * std::pow(s.curvature_per_m * reach, 2) < 1.0)) {
    throw std::invalid_argument("surface: the aperture reaches beyond the equator of the conic");
  }
}

}  // namespace twinbench::optics
