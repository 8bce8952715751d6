#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "optics/surface.h"

/// Triangles: fixtures and housings, and the stand-ins of analytic surfaces that Embree sees.
namespace twinbench::optics {

/// Triangles in a frame of their own, M. Those of a fixture absorb; float accuracy (about 100 nm) is enough for
/// them.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A closed box between two corners.
TriangleMesh BoxMesh(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m);

/// Stand-in that contains the surface with at least `pad_m` to spare, in the world frame: a plane becomes two
/// triangles that overlap along the diagonal, a curved surface its box.
TriangleMesh ProxyOf(const Surface& surface, double pad_m);

/// @throws std::invalid_argument if a triangle names a vertex that is not there or a coordinate is not finite.
void Validate(const TriangleMesh& mesh);

/// Distance along the ray to the nearest triangle beyond t_min, in double (Moeller and Trumbore); infinite for
/// none.
double MeetMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& X_WM, const Ray& ray, double t_min_m);

}  // namespace twinbench::optics
