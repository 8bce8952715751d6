#include "optics/returned_beam.h"

#include <cmath>

// Compiled for three instruction sets as optics/kernels.cc is; sums go in lanes of fixed number, so all of them give the
// same bits.

namespace twinbench::optics {

struct ReturningRays {
  double* __restrict ox, * __restrict oy, * __restrict oz, * __restrict dx, * __restrict dy, * __restrict dz;
};

struct MetPoints {
  const int* __restrict surface;
  const double* __restrict x, * __restrict y;
};

[[gnu::target_clones("avx512f", "avx2", "default")]] void ReflectArrays(const Frame& mirror, int id, ConstRays in,
                                                                        MetPoints met, std::size_t n,
                                                                        ReturningRays out) {
  const Frame f = mirror;
  const double c = f.curvature, k = f.one_plus_conic;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = met.x[i], y = met.y[i], r2 = x * x + y * y;
    const double sag = c * r2 / (1.0 + std::sqrt(1.0 - k * c * c * r2));
    const double nx = -c * x, ny = -c * y, nz = 1.0 - k * c * sag;
    const double to_unit = 1.0 / std::sqrt(nx * nx + ny * ny + nz * nz);
    const double ax = to_unit * (nx * f.xx + ny * f.yx + nz * f.zx);
    const double ay = to_unit * (nx * f.xy + ny * f.yy + nz * f.zy);
    const double az = to_unit * (nx * f.xz + ny * f.yz + nz * f.zz);
    const double toward = in.dx[i] * ax + in.dy[i] * ay + in.dz[i] * az;
    const bool meets = met.surface[i] == id, in_front = toward < 0.0;
    const bool turns = meets & in_front;
    out.ox[i] = turns ? f.cx + (x * f.xx + y * f.yx + sag * f.zx) : in.ox[i];
    out.oy[i] = turns ? f.cy + (x * f.xy + y * f.yy + sag * f.zy) : in.oy[i];
    out.oz[i] = turns ? f.cz + (x * f.xz + y * f.yz + sag * f.zz) : in.oz[i];
    out.dx[i] = turns ? in.dx[i] - 2.0 * toward * ax : in.dx[i];
    out.dy[i] = turns ? in.dy[i] - 2.0 * toward * ay : in.dy[i];
    out.dz[i] = turns ? in.dz[i] - 2.0 * toward * az : in.dz[i];
  }
}

void ReflectFrom(const Frame& mirror, int id, const RayBatch& outgoing, const HitBatch& hits, RayBatch& returning) {
  returning.Resize(outgoing.size());
  ReflectArrays(mirror, id, From(outgoing, 0), {hits.surface.data(), hits.x_m.data(), hits.y_m.data()},
                outgoing.size(),
                {returning.ox.data(), returning.oy.data(), returning.oz.data(), returning.dx.data(),
                 returning.dy.data(), returning.dz.data()});
}

namespace {

constexpr std::size_t kLanes = 8;

struct Lanes {
  double light[kLanes] = {}, x_m[kLanes] = {}, y_m[kLanes] = {};
};

/// One ray of each lane.
[[gnu::always_inline]] inline void Take(const ImagingLens& lens, int objective, ConstRays rays, MetPoints met,
                                        std::size_t n, Lanes& lanes) {
  const double f = lens.focal_length_m, image_m = f + lens.defocus_m, out_of_focus = lens.defocus_m / f;
  const double enlarging = lens.distortion_per_rad2 / (f * f);
  for (std::size_t i = 0; i < n; ++i) {
    const bool arrives = met.surface[i] == objective;
    const double x = arrives ? met.x[i] : 0.0, y = arrives ? met.y[i] : 0.0, dz = arrives ? rays.dz[i] : -1.0;
    const double u = image_m * (rays.dx[i] / -dz) - out_of_focus * x;
    const double v = image_m * (rays.dy[i] / -dz) - out_of_focus * y;
    const double inside = lens.edge.ShareInside(std::sqrt(x * x + y * y));
    const double share = arrives ? inside : 0.0, enlarged = share * (1.0 + enlarging * (u * u + v * v));
    lanes.light[i] += share;
    lanes.x_m[i] -= enlarged * u;  // x of the lens points to the left
    lanes.y_m[i] += enlarged * v;
  }
}

}  // namespace

[[gnu::target_clones("avx512f", "avx2", "default")]] void SumArrays(const ImagingLens& lens, int objective,
                                                                    ConstRays rays, MetPoints met, std::size_t n,
                                                                    Lanes& lanes) {
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes)
    Take(lens, objective, rays.From(i), {met.surface + i, met.x + i, met.y + i}, kLanes, lanes);
  Take(lens, objective, rays.From(i), {met.surface + i, met.x + i, met.y + i}, n - i, lanes);
}

CameraSums SumOnCamera(const ImagingLens& lens, int objective, const RayBatch& returning, const HitBatch& hits) {
  Lanes lanes;
  SumArrays(lens, objective, From(returning, 0), {hits.surface.data(), hits.x_m.data(), hits.y_m.data()},
            returning.size(), lanes);
  CameraSums sums;
  for (std::size_t i = 0; i < kLanes; ++i) {
    sums.light += lanes.light[i];
    sums.x_m += lanes.x_m[i];
    sums.y_m += lanes.y_m[i];
  }
  return sums;
}

}  // namespace twinbench::optics
