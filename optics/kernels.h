#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "optics/surface.h"

/// The arithmetic shared by every path through a scene: one formula, so one and many rays give the same bits.
namespace twinbench::optics {

/// A surface as plain numbers: origin, axes (rows of R_SW), shape and aperture.
struct Frame {
  double cx, cy, cz;
  double xx, xy, xz;
  double yx, yy, yz;
  double zx, zy, zz;
  double curvature, one_plus_conic;
  double half_x, half_y, radius2;
};

Frame MakeFrame(const Surface& surface);

/// The arrays of a RayBatch from some ray on.
struct ConstRays {
  const double* __restrict ox, * __restrict oy, * __restrict oz, * __restrict dx, * __restrict dy, * __restrict dz;

  ConstRays From(std::size_t i) const { return {ox + i, oy + i, oz + i, dx + i, dy + i, dz + i}; }
};

inline ConstRays From(const RayBatch& rays, std::size_t begin) {
  return {rays.ox.data() + begin, rays.oy.data() + begin, rays.oz.data() + begin,
          rays.dx.data() + begin, rays.dy.data() + begin, rays.dz.data() + begin};
}

/// Where a ray meets the plane z_S = 0, as (t, x, y).
///
/// x and y come from t d - (c - o), not from o + t d - c: differences first keeps the last digits.
[[gnu::always_inline]] inline void MeetPlane(const Frame& f, double ox, double oy, double oz, double dx, double dy,
                                             double dz, double& t, double& x, double& y) {
  const double rx = f.cx - ox, ry = f.cy - oy, rz = f.cz - oz;
  t = (rx * f.zx + ry * f.zy + rz * f.zz) / (dx * f.zx + dy * f.zy + dz * f.zz);
  const double px = t * dx - rx, py = t * dy - ry, pz = t * dz - rz;
  x = px * f.xx + py * f.xy + pz * f.xz;
  y = px * f.yx + py * f.yy + pz * f.yz;
}

/// Roots of A t^2 + 2 B t + C = 0 without cancellation; the first stays finite when A -> 0 (collimated on a
/// paraboloid).
[[gnu::always_inline]] inline void StableRoots(double a, double b, double c, double& t1, double& t2) {
  const double root = std::sqrt(b * b - a * c);
  const double w = -(b + std::copysign(root, b));
  t1 = c / w;
  t2 = w / a;
}

/// Where a ray meets the sheet of a conic that carries the vertex; t is infinite for none.
[[gnu::always_inline]] inline void MeetConic(const Frame& f, double t_min, double ox, double oy, double oz,
                                             double dx, double dy, double dz, double& t, double& x, double& y) {
  const double rx = ox - f.cx, ry = oy - f.cy, rz = oz - f.cz;
  const double px = rx * f.xx + ry * f.xy + rz * f.xz, qx = dx * f.xx + dy * f.xy + dz * f.xz;
  const double py = rx * f.yx + ry * f.yy + rz * f.yz, qy = dx * f.yx + dy * f.yy + dz * f.yz;
  const double pz = rx * f.zx + ry * f.zy + rz * f.zz, qz = dx * f.zx + dy * f.zy + dz * f.zz;
  const double c = f.curvature, k = f.one_plus_conic;
  double t1, t2;
  StableRoots(c * (qx * qx + qy * qy + k * qz * qz), c * (px * qx + py * qy + k * pz * qz) - qz,
              c * (px * px + py * py + k * pz * pz) - 2.0 * pz, t1, t2);
  const double none = std::numeric_limits<double>::infinity();
  // Beyond the equator 1 - (1 + k) c z changes sign: that is the other half of the ellipsoid or the other sheet.
  const bool good1 = (t1 > t_min) & (k * c * (pz + t1 * qz) < 1.0);
  const bool good2 = (t2 > t_min) & (k * c * (pz + t2 * qz) < 1.0);
  t1 = good1 ? t1 : none;
  t2 = good2 ? t2 : none;
  t = t1 < t2 ? t1 : t2;
  x = px + t * qx;
  y = py + t * qy;
}

// Named first: no branches, so that the loops over rays become vector code.

[[gnu::always_inline]] inline bool InRectangle(const Frame& f, double x, double y) {
  const bool in_x = std::abs(x) <= f.half_x, in_y = std::abs(y) <= f.half_y;
  return in_x & in_y;
}

[[gnu::always_inline]] inline bool InAperture(const Frame& f, double x, double y) {
  const bool in_rectangle = InRectangle(f, x, y), in_circle = x * x + y * y <= f.radius2;
  return in_rectangle & in_circle;
}

/// Meets one surface beyond t_min, inside its aperture; t is infinite if there is no such point.
[[gnu::always_inline]] inline SurfaceHit Meet(const Frame& f, const Ray& ray, double t_min_m) {
  const Eigen::Vector3d &o = ray.origin_m, &d = ray.direction;
  SurfaceHit hit;
  double t;
  if (f.curvature == 0.0) {
    MeetPlane(f, o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), t, hit.x_m, hit.y_m);
  } else {
    MeetConic(f, t_min_m, o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), t, hit.x_m, hit.y_m);
  }
  if (t > t_min_m && InAperture(f, hit.x_m, hit.y_m)) hit.t_m = t;
  return hit;
}

/// The surface met first beyond t_min; of equal distances the lower index. One ray, a few surfaces.
NearestHit Nearest(std::span<const Frame> frames, const Ray& ray, double t_min_m);

/// Sixteen rays at most are traced together.
inline constexpr int kMaxPacket = 16;

/// What Embree says of some rays.
struct Answers {
  int* __restrict triangle;  // of the proxies; kNothing or kFixture
  float* __restrict t_m;     // infinite for kNothing

  Answers From(std::size_t i) const { return {triangle + i, t_m + i}; }
};

/// How Embree's scenes number their geometries: all proxies together, and in each mesh's own scene the mesh.
inline constexpr unsigned kProxyGeometry = 0, kMeshGeometry = 1;

/// The same as Embree says it.
struct RawAnswers {
  unsigned* __restrict geometry;   // neither of these numbers: nothing is met
  unsigned* __restrict primitive;  // undefined for nothing
  float* __restrict t_m;

  RawAnswers From(std::size_t i) const { return {geometry + i, primitive + i, t_m + i}; }
};

/// Of `n` rays.
void Name(RawAnswers raw, std::size_t n, Answers answers);

struct TriangleRange {
  int first = 0, end = 0;
};

/// One surface among the proxies.
struct Target {
  Frame frame;
  TriangleRange triangles;
  bool alone;  // a plane whose proxy no other proxy touches: where Embree names it, no other surface can be meant
};

/// The surfaces as Embree's triangle numbers find them.
struct Targets {
  const Target* surfaces;
  const int* surface_of_triangle;
  float blur_m;  // distance that float cannot resolve
};

/// Recomputes in double `n` rays, whole packets of `width`, as far as all rays of a packet meet one lone plane.
/// @return A bit for each of at most 32 packets, set where that is not so; the hits of such packets are undefined.
std::uint32_t SettlePlanes(const Targets& targets, const RayBatch& rays, std::size_t begin, std::size_t n,
                           std::size_t width, RawAnswers raw, double t_min, HitBatch& hits);

/// Puts the meshes that Embree found in front of what `n` rays have met so far.
/// @return Whether some ray has met nothing as near as Embree says: it passed through the padding and must go on.
bool Compare(Answers answers, float blur_m, std::size_t begin, std::size_t n, HitBatch& hits);

/// Takes surface `id` into the running nearest hit of `n` rays; of equal distances the lower id wins.
void TakeNearest(const Frame& frame, int id, const RayBatch& rays, std::size_t begin, std::size_t n, double t_min,
                 HitBatch& hits);

}  // namespace twinbench::optics
