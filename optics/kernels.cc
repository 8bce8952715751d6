#include "optics/kernels.h"

#include <algorithm>

// Each kernel is compiled for three instruction sets and one is chosen when the program is loaded. Contraction is
// off (cmake/compiler.cmake), so all of them give the same bits.

namespace twinbench::optics {

struct BestHits {
  int* __restrict surface;
  double* __restrict t, * __restrict x, * __restrict y;
};

BestHits From(HitBatch& hits, std::size_t begin) {
  return {hits.surface.data() + begin, hits.t_m.data() + begin, hits.x_m.data() + begin, hits.y_m.data() + begin};
}

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
  const auto kernel = frame.curvature == 0.0 ? TakeNearestPlane : TakeNearestConic;
  kernel(frame, id, From(rays, begin), n, t_min, From(hits, begin));
}

/// Rays that all seem to meet one plane.
/// @return Whether each names one of its triangles and meets it no later than Embree says.
template <bool kIsRound>
[[gnu::always_inline]] inline bool MeetLonePlane(const Target& target, int surface, float blur_m, ConstRays r,
                                                 std::size_t n, RawAnswers answers, double t_min, BestHits best) {
  const Frame f = target.frame;
  const auto first = static_cast<unsigned>(target.triangles.first);
  const auto triangles = static_cast<unsigned>(target.triangles.end) - first;
  unsigned other = 0;
  for (std::size_t i = 0; i < n; ++i) {
    best.surface[i] = surface;
    const unsigned is_other = answers.primitive[i] - first < triangles ? 0 : 1;
    other |= (answers.geometry[i] - kProxyGeometry) | is_other;
  }
  std::int64_t open = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double t, x, y;
    MeetPlane(f, r.ox[i], r.oy[i], r.oz[i], r.dx[i], r.dy[i], r.dz[i], t, x, y);
    const double t_embree = static_cast<double>(answers.t_m[i]) + blur_m;
    const bool inside = kIsRound ? InAperture(f, x, y) : InRectangle(f, x, y);
    const bool met = inside & (t > t_min) & (t <= t_embree);
    best.t[i] = t;
    best.x[i] = x;
    best.y[i] = y;
    open |= met ? 0 : 1;
  }
  return other == 0 && open == 0;
}

[[gnu::target_clones("avx512f", "avx2", "default")]] bool MeetLoneRectangle(const Target& target, int surface,
                                                                            float blur_m, ConstRays r,
                                                                            std::size_t n, RawAnswers answers,
                                                                            double t_min, BestHits best) {
  return MeetLonePlane<false>(target, surface, blur_m, r, n, answers, t_min, best);
}

[[gnu::target_clones("avx512f", "avx2", "default")]] bool MeetLoneCircle(const Target& target, int surface,
                                                                         float blur_m, ConstRays r, std::size_t n,
                                                                         RawAnswers answers, double t_min,
                                                                         BestHits best) {
  return MeetLonePlane<true>(target, surface, blur_m, r, n, answers, t_min, best);
}

void Name(RawAnswers raw, std::size_t n, Answers answers) {
  for (std::size_t i = 0; i < n; ++i) {
    answers.triangle[i] = kNothing;
    if (raw.geometry[i] == kProxyGeometry) answers.triangle[i] = static_cast<int>(raw.primitive[i]);
    if (raw.geometry[i] == kMeshGeometry) answers.triangle[i] = kFixture;
    answers.t_m[i] = raw.t_m[i];
  }
}

[[gnu::target_clones("avx512f", "avx2", "default")]] bool CompareArrays(Answers answers, float blur_m,
                                                                        std::size_t n, BestHits best) {
  int open = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = answers.t_m[i];
    const bool fixture = (answers.triangle[i] == kFixture) & (t < best.t[i]);
    best.surface[i] = fixture ? kFixture : best.surface[i];
    best.t[i] = fixture ? t : best.t[i];
    open |= !(best.t[i] <= t + blur_m);
  }
  return open != 0;
}

bool Compare(Answers answers, float blur_m, std::size_t begin, std::size_t n, HitBatch& hits) {
  return CompareArrays(answers, blur_m, n, From(hits, begin));
}

/// Of `n` rays' answers, whole packets of `width`.
struct AnswersInPackets {
  const Targets& targets;
  RawAnswers raw;
  std::size_t n, width;

  int SurfaceOf(std::size_t i) const {
    return raw.geometry[i] == kProxyGeometry ? targets.surface_of_triangle[raw.primitive[i]] : kNothing;
  }

  std::size_t NextPacket(std::size_t i) const { return i + width - i % width; }

  /// End of the rays from `begin` on that seem to meet its surface, as far as the ends of the packets show, for
  /// neighbours of a beam travel together. Where one beam follows on another within a packet, the run ends there.
  std::size_t RunEnd(std::size_t begin) const {
    const int surface = SurfaceOf(begin);
    std::size_t end = begin;
    while (end < n && SurfaceOf(end) == surface) {
      const std::size_t next = NextPacket(end);
      if (SurfaceOf(next - 1) != surface) {
        while (SurfaceOf(end) == surface) ++end;
        return end;
      }
      end = next;
    }
    return end;
  }
};

std::uint32_t SettlePlanes(const Targets& targets, const RayBatch& rays, std::size_t begin, std::size_t n,
                           std::size_t width, RawAnswers raw, double t_min, HitBatch& hits) {
  const AnswersInPackets answers{targets, raw, n, width};
  const auto meet = [&](int surface, std::size_t from, std::size_t to) {
    const Target& target = targets.surfaces[surface];
    const auto kernel = std::isinf(target.frame.radius2) ? MeetLoneRectangle : MeetLoneCircle;
    return kernel(target, surface, targets.blur_m, From(rays, begin + from), to - from, raw.From(from), t_min,
                  From(hits, begin + from));
  };
  std::uint32_t unsettled = 0;
  for (std::size_t from = 0, to; from < n; from = to) {
    // Packets in a row on one surface, as those of a beam are: one call for all.
    const int surface = answers.SurfaceOf(from);
    to = answers.RunEnd(from);
    const bool hopeful = surface != kNothing && targets.surfaces[surface].alone;
    if (hopeful && meet(surface, from, to)) continue;
    for (std::size_t i = from, end; i < to; i = end) {
      end = std::min(to, answers.NextPacket(i));
      const bool settled = hopeful && to - from > width && meet(surface, i, end);
      unsettled |= static_cast<std::uint32_t>(!settled) << (i / width);
    }
  }
  return unsettled;
}

}  // namespace twinbench::optics
