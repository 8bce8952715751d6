#include "optics/triangulation.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace twinbench::optics {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A surface's pose from its centre, its x and its z.
Isometry3d PoseFrom(const Vector3d& centre_m, const Vector3d& x, const Vector3d& z) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = centre_m;
  return pose;
}

void CheckTriangulation(const TriangulationParameters& p) {
  if (!(p.object_m > 0.0) || !(p.image_m > 0.0) || !(p.lens_radius_m > 0.0))
    throw std::invalid_argument("triangulation: distances and the lens' radius must be positive");
  if (!(p.alpha_rad > 0.0) || !(p.alpha_rad < 0.5 * std::numbers::pi))
    throw std::invalid_argument("triangulation: the angle must be between 0 and 90 deg");
}

}  // namespace

Triangulation::Triangulation(const TriangulationParameters& p) {
  CheckTriangulation(p);
  const double beta_rad = std::atan(p.object_m * std::tan(p.alpha_rad) / p.image_m);
  const Vector3d axis(std::sin(p.alpha_rad), 0.0, std::cos(p.alpha_rad));     // from the spot to the sensor
  const Vector3d across(std::cos(p.alpha_rad), 0.0, -std::sin(p.alpha_rad));  // to which a spot beyond lies
  X_TL_ = PoseFrom(p.object_m * axis, across, -axis);
  // What lies beyond appears on the other side of the axis, and nearer to the lens.
  const Vector3d along = -std::sin(beta_rad) * across - std::cos(beta_rad) * axis;
  const Vector3d towards_light = std::cos(beta_rad) * across - std::sin(beta_rad) * axis;
  const Isometry3d sensor = PoseFrom((p.object_m + p.image_m) * axis, along, towards_light);
  const int lens =
      elements_.Add(CircularPlane(X_TL_, p.lens_radius_m), ThinLens{1.0 / (1.0 / p.object_m + 1.0 / p.image_m)});
  // The nominal spot's image is its middle; beyond +- image no lens of this kind would be sharp.
  const int line = elements_.Add(RectangularPlane(sensor, 2.0 * p.image_m, 2.0 * p.lens_radius_m), Sink{});
  elements_.Commit();
  way_ = {{lens}, {line}};
}

double Triangulation::Seen_m(const Vector3d& spot_m, const Eigen::Vector2d& pupil_m) const {
  const Vector3d to = X_TL_ * Vector3d(pupil_m.x(), pupil_m.y(), 0.0);
  RayBatch ray;
  ray.Add({spot_m, (to - spot_m).normalized()});
  HitBatch hit;
  elements_.FollowWay(way_, ray, hit);
  return hit.surface[0] == way_.back().element ? hit.x_m[0] : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace twinbench::optics
