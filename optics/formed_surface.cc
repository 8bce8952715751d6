#include "optics/formed_surface.h"

#include <cmath>

namespace twinbench::optics {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d SlopeOfSag(const Surface& s, double x_m, double y_m) {
  const double c = s.curvature_per_m;
  return c * Vector2d(x_m, y_m) / (1.0 - c * (1.0 + s.conic) * Sag(s, x_m, y_m));
}

/// From the conic to the heights on it: every step leaves some 1e-4 of the distance.
void OnHeights(const Surface& s, const HeightMap& form, const Vector2d& vertex_m, const Vector3d& direction,
               Vector3d& point_m, Vector3d& normal) {
  constexpr int kSteps = 4;
  for (int step = 0; step < kSteps; ++step) {
    const HeightAt at = Interpolate(form, vertex_m.x() + point_m.x(), vertex_m.y() + point_m.y());
    const Vector2d slope = SlopeOfSag(s, point_m.x(), point_m.y()) + at.slope;
    const double above_m = point_m.z() - Sag(s, point_m.x(), point_m.y()) - at.height_m;
    point_m -= above_m / (direction.z() - slope.dot(direction.head<2>())) * direction;
  }
  const HeightAt at = Interpolate(form, vertex_m.x() + point_m.x(), vertex_m.y() + point_m.y());
  const Vector2d slope = SlopeOfSag(s, point_m.x(), point_m.y()) + at.slope;
  normal = Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
}

}  // namespace

void SurfacePoints::Resize(std::size_t size) {
  is_met.resize(size);
  point_m.resize(size);
  normal.resize(size);
}

FormedSurface::FormedSurface(Surface surface) {
  surface.X_WS = Eigen::Isometry3d::Identity();
  scene_.AddSurface(surface);
  scene_.Commit();
}

void FormedSurface::Meet(const RayBatch& rays, const HeightMap* form, const Vector2d& vertex_m,
                         SurfacePoints& points) const {
  const Surface& surface = scene_.surfaces().front();
  HitBatch hits;
  scene_.Intersect(rays, hits);
  points.Resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    points.is_met[i] = hits.surface[i] == 0;
    if (!points.is_met[i]) continue;
    const Vector3d direction = rays.At(i).direction;
    points.point_m[i] = Point(surface, hits.x_m[i], hits.y_m[i]);
    points.normal[i] = Normal(surface, hits.x_m[i], hits.y_m[i]);
    if (form) OnHeights(surface, *form, vertex_m, direction, points.point_m[i], points.normal[i]);
    points.is_met[i] = direction.dot(points.normal[i]) < 0.0;
  }
}

}  // namespace twinbench::optics
