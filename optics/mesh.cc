#include "optics/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace twinbench::optics {
namespace {

/// Rectangle |x| <= a, |y| <= b as two triangles whose long sides are pushed apart by `overlap` each, so that no
/// ray slips between them in float.
TriangleMesh OverlappingTriangles(double a, double b, double overlap_m) {
  const double height = 2.0 * a * b / std::hypot(a, b);  // corner to diagonal
  const double grow = 1.0 + overlap_m / height;
  const double w = 2.0 * a * grow, h = 2.0 * b * grow;
  return {.vertices_m =
              {{a, -b, 0.0}, {a - w, -b, 0.0}, {a, h - b, 0.0}, {-a, b, 0.0}, {w - a, b, 0.0}, {-a, b - h, 0.0}},
          .triangles = {{0, 2, 1}, {3, 5, 4}}};
}

double Reach(const Surface& s, double half_m) {
  return std::min(half_m, s.radius_m);
}

TriangleMesh LocalProxy(const Surface& s, double pad_m) {
  const double a = Reach(s, s.half_x_m), b = Reach(s, s.half_y_m);
  if (s.curvature_per_m == 0.0) return OverlappingTriangles(a + pad_m, b + pad_m, pad_m);
  const double r = std::min(s.radius_m, std::hypot(a, b));
  const double sag = Sag(s, r, 0.0);
  return BoxMesh({-a - pad_m, -b - pad_m, std::min(sag, 0.0) - pad_m},
                 {a + pad_m, b + pad_m, std::max(sag, 0.0) + pad_m});
}

double MeetTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Ray& ray) {
  const Eigen::Vector3d ab = b - a, ac = c - a, p = ray.direction.cross(ac), from_a = ray.origin_m - a;
  const double inverse = 1.0 / ab.dot(p);
  const double u = from_a.dot(p) * inverse;
  const Eigen::Vector3d q = from_a.cross(ab);
  const double v = ray.direction.dot(q) * inverse;
  const bool inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
  return inside ? ac.dot(q) * inverse : std::numeric_limits<double>::infinity();
}

}  // namespace

TriangleMesh BoxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices_m.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

TriangleMesh ProxyOf(const Surface& surface, double pad_m) {
  TriangleMesh proxy = LocalProxy(surface, pad_m);
  for (Eigen::Vector3d& vertex : proxy.vertices_m) vertex = surface.X_WS * vertex;
  return proxy;
}

void Validate(const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) {
    if (!vertex.allFinite()) throw std::invalid_argument("mesh: a vertex is not finite");
  }
  for (const auto& triangle : mesh.triangles) {
    if (std::ranges::any_of(triangle, [&](std::uint32_t i) { return i >= mesh.vertices_m.size(); })) {
      throw std::invalid_argument("mesh: a triangle names a vertex that is not there");
    }
  }
}

double MeetMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& X_WM, const Ray& ray, double t_min_m) {
  const Eigen::Isometry3d X_MW = X_WM.inverse();
  const Ray ray_M{X_MW * ray.origin_m, X_MW.linear() * ray.direction};
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    const double t = MeetTriangle(mesh.vertices_m[a], mesh.vertices_m[b], mesh.vertices_m[c], ray_M);
    if (t > t_min_m && t < nearest) nearest = t;
  }
  return nearest;
}

}  // namespace twinbench::optics
