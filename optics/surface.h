#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "optics/ray.h"

/// Analytic surfaces in double precision. Optics are never tessellated: float vertices alone cost 0.3 arcsec.
namespace twinbench::optics {

/// A conic of revolution about z with its vertex at the origin of frame S: c (x^2 + y^2 + (1 + k) z^2) = 2 z.
/// A plane has c = 0, a sphere k = 0, a paraboloid k = -1. The aperture is a rectangle, a circle or both.
struct Surface {
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  double curvature_per_m = 0.0;
  double conic = 0.0;
  double half_x_m = std::numeric_limits<double>::quiet_NaN();
  double half_y_m = std::numeric_limits<double>::quiet_NaN();
  double radius_m = std::numeric_limits<double>::infinity();
};

Surface RectangularPlane(const Eigen::Isometry3d& X_WS, double width_m, double height_m);
Surface CircularPlane(const Eigen::Isometry3d& X_WS, double radius_m);
/// Centre of curvature on +z for a positive radius.
Surface Sphere(const Eigen::Isometry3d& X_WS, double curvature_radius_m, double radius_m);
/// z = r^2 / (4 f), focus on +z for a positive focal length.
Surface Paraboloid(const Eigen::Isometry3d& X_WS, double focal_length_m, double radius_m);

/// Unit normal at a point of the surface given in S, on the side of +z; in the world frame.
Eigen::Vector3d Normal(const Surface& surface, double x_m, double y_m);

/// The point (x, y) of the surface in the world frame.
Eigen::Vector3d Point(const Surface& surface, double x_m, double y_m);

/// Depth z_S of the surface at (x, y) [m].
double Sag(const Surface& surface, double x_m, double y_m);

struct SurfaceHit {
  double t_m = std::numeric_limits<double>::infinity();
  double x_m = 0.0;
  double y_m = 0.0;
};

/// Meets one surface beyond t_min, inside its aperture; t is infinite if there is no such point.
SurfaceHit Meet(const Surface& surface, const Ray& ray, double t_min_m);

struct NearestHit {
  int index = kNothing;  // of the surface; kNothing, or kFixture for a mesh
  SurfaceHit hit;
};

/// @throws std::invalid_argument naming what is wrong: a size that is not positive, a pose that is not a rotation,
/// an
///         aperture that reaches beyond the conic's equator.
void Validate(const Surface& surface);

}  // namespace twinbench::optics
