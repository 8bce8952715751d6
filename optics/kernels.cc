#include "optics/kernels.h"

// Each kernel is compiled for three instruction sets and one is chosen when the program is loaded. Contraction is
// off (cmake/compiler.cmake), so all of them give the same bits.

namespace twinbench::optics {

struct ConstRays {
  const double* __restrict ox, * __restrict oy, * __restrict oz, * __restrict dx, * __restrict dy, * __restrict dz;
};

struct BestHits {
  int* __restrict surface;
  double* __restrict t, * __restrict x, * __restrict y;
};

[[gnu::target_clones("avx512f", "avx2", "default")]] void TakeNearestPlane(const Frame& frame, int id, ConstRays r,
                                                                           std::size_t n, double t_min,
                                                                           BestHits best) {
  const Frame f = frame;
  for (std::size_t i = 0; i < n; ++i) {
    double t, x, y;
    MeetPlane(f, r.ox[i], r.oy[i], r.oz[i], r.dx[i], r.dy[i], r.dz[i], t, x, y);
    const bool nearer = (t < best.t[i]) | ((t == best.t[i]) & (id < best.surface[i]));
    const bool inside = InAperture(f, x, y);
    const bool take = inside & (t > t_min) & nearer;
    best.surface[i] = take ? id : best.surface[i];
    best.t[i] = take ? t : best.t[i];
    best.x[i] = take ? x : best.x[i];
    best.y[i] = take ? y : best.y[i];
  }
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void TakeNearestConic(const Frame& frame, int id, ConstRays r,
                                                                           std::size_t n, double t_min,
                                                                           BestHits best) {
  const Frame f = frame;
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    double t, x, y;
    MeetConic(f, t_min, r.ox[i], r.oy[i], r.oz[i], r.dx[i], r.dy[i], r.dz[i], t, x, y);
    const bool nearer = (t < best.t[i]) | ((t == best.t[i]) & (id < best.surface[i]));
    const bool inside = InAperture(f, x, y);
    const bool take = inside & (t < infinity) & nearer;
    best.surface[i] = take ? id : best.surface[i];
    best.t[i] = take ? t : best.t[i];
    best.x[i] = take ? x : best.x[i];
    best.y[i] = take ? y : best.y[i];
  }
}

void TakeNearest(const Frame& frame, int id, const RayBatch& rays, std::size_t begin, std::size_t n, double t_min,
                 HitBatch& hits) {
  const ConstRays r{rays.ox.data() + begin, rays.oy.data() + begin, rays.oz.data() + begin,
                    rays.dx.data() + begin, rays.dy.data() + begin, rays.dz.data() + begin};
  const BestHits best{hits.surface.data() + begin, hits.t_m.data() + begin, hits.x_m.data() + begin,
                      hits.y_m.data() + begin};
  const auto kernel = frame.curvature == 0.0 ? TakeNearestPlane : TakeNearestConic;
  kernel(frame, id, r, n, t_min, best);
}

struct FloatRays {
  float* __restrict ox, * __restrict oy, * __restrict oz, * __restrict dx, * __restrict dy, * __restrict dz;
};

[[gnu::target_clones("avx512f", "avx2", "default")]] void ToFloatArrays(ConstRays from, std::size_t n,
                                                                        FloatRays to) {
  // + 0 turns -0 into +0, so that the sign of a zero never sends a ray to another octant of Embree's packets.
  for (std::size_t i = 0; i < n; ++i) {
    to.ox[i] = static_cast<float>(from.ox[i]);
    to.oy[i] = static_cast<float>(from.oy[i]);
    to.oz[i] = static_cast<float>(from.oz[i]);
    to.dx[i] = static_cast<float>(from.dx[i]) + 0.0f;
    to.dy[i] = static_cast<float>(from.dy[i]) + 0.0f;
    to.dz[i] = static_cast<float>(from.dz[i]) + 0.0f;
  }
}

void ToFloat(const RayBatch& rays, std::size_t begin, std::size_t n, const std::array<float*, 6>& to) {
  const ConstRays from{rays.ox.data() + begin, rays.oy.data() + begin, rays.oz.data() + begin,
                       rays.dx.data() + begin, rays.dy.data() + begin, rays.dz.data() + begin};
  ToFloatArrays(from, n, {to[0], to[1], to[2], to[3], to[4], to[5]});
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void TraceSequenceArrays(const Frame& grating, double shift,
                                                                              const Frame& plane, ConstRays r,
                                                                              std::size_t n, double* __restrict u,
                                                                              double* __restrict v) {
  const Frame g = grating, p = plane;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < n; ++i) {
    double t, x, y;
    MeetPlane(g, r.ox[i], r.oy[i], r.oz[i], r.dx[i], r.dy[i], r.dz[i], t, x, y);
    const double toward = r.dx[i] * g.zx + r.dy[i] * g.zy + r.dz[i] * g.zz;
    const double kx = r.dx[i] - toward * g.zx + shift * g.xx;
    const double ky = r.dy[i] - toward * g.zy + shift * g.xy;
    const double kz = r.dz[i] - toward * g.zz + shift * g.xz;
    const double q = 1.0 - (kx * kx + ky * ky + kz * kz);
    const bool inside = InAperture(g, x, y);
    const bool good = inside & (t > 0.0) & (q > 0.0) & (toward < 0.0);
    const double out = std::sqrt(q > 0.0 ? q : 0.0);
    double t2, u2, v2;
    MeetPlane(p, r.ox[i] + t * r.dx[i], r.oy[i] + t * r.dy[i], r.oz[i] + t * r.dz[i], kx + out * g.zx,
              ky + out * g.zy, kz + out * g.zz, t2, u2, v2);
    const bool arrives = good & (t2 > 0.0);
    u[i] = arrives ? u2 : nan;
    v[i] = arrives ? v2 : nan;
  }
}

void TraceSequence(const Frame& grating, double order_lambda_rho, const Frame& plane, const RayBatch& rays,
                   double* u_m, double* v_m) {
  const ConstRays r{rays.ox.data(), rays.oy.data(), rays.oz.data(), rays.dx.data(), rays.dy.data(), rays.dz.data()};
  TraceSequenceArrays(grating, order_lambda_rho, plane, r, rays.size(), u_m, v_m);
}

}  // namespace twinbench::optics
