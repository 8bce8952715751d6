// What does exactness cost? Bare Embree packets against the same rays with every hit recomputed in double.
// The argument is the number of surfaces, then of mesh triangles. Run: bench_optics --benchmark_min_time=0.5

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>
#include <vector>

#include "optics/bench.h"

namespace twinbench::optics {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t kRays = 1 << 14;

/// A bumpy housing around the optics, about `triangles` of them.
TriangleMesh Housing(int triangles) {
  const int n = static_cast<int>(std::sqrt(triangles / 2.0));
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double theta = std::numbers::pi * i / n, phi = 2.0 * std::numbers::pi * j / n;
      const double r = 0.5 + 0.01 * std::sin(20.0 * phi) * std::sin(20.0 * theta);
      mesh.vertices_m.emplace_back(r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                                   r * std::cos(theta));
    }
  }
  const auto row = static_cast<std::uint32_t>(n + 1);
  for (std::uint32_t i = 0; i + 1 < row; ++i) {
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t a = i * row + j;
      mesh.triangles.push_back({a, a + 1, a + row});
      mesh.triangles.push_back({a + 1, a + row + 1, a + row});
    }
  }
  return mesh;
}

Scene MakeScene(int surfaces, int triangles) {
  Scene scene;
  for (int i = 0; i < surfaces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / surfaces;
    Isometry3d X(Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * Eigen::Translation3d(0.2, 0, 0) *
                 Eigen::AngleAxisd(-std::numbers::pi / 2, Vector3d::UnitY()));
    scene.AddSurface(RectangularPlane(X, 0.025, 0.025));
  }
  if (triangles > 0) scene.AddMesh(Housing(triangles), Isometry3d::Identity());
  scene.Commit();
  return scene;
}

/// Beams of 0.5 mm from the middle, one after the other to each surface.
RayBatch Beams(const Scene& scene) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  RayBatch rays;
  for (std::size_t i = 0; i < kRays; ++i) {
    const std::size_t s = i * scene.surfaces().size() / kRays;
    const Vector3d to = scene.surfaces()[s].X_WS.translation();
    const Vector3d from = 0.25e-3 * Vector3d(normal(random), normal(random), normal(random));
    rays.Add({from, to.normalized()});
  }
  return rays;
}

std::vector<RTCRayHit16> Packets(const RayBatch& rays) {
  std::vector<RTCRayHit16> packets(rays.size() / 16);
  for (std::size_t i = 0; i < packets.size() * 16; ++i) {
    auto& [ray, hit] = packets[i / 16];
    const std::size_t lane = i % 16;
    const Ray r = rays.At(i);
    ray.org_x[lane] = static_cast<float>(r.origin_m.x());
    ray.org_y[lane] = static_cast<float>(r.origin_m.y());
    ray.org_z[lane] = static_cast<float>(r.origin_m.z());
    ray.dir_x[lane] = static_cast<float>(r.direction.x()) + 0.0f;
    ray.dir_y[lane] = static_cast<float>(r.direction.y()) + 0.0f;
    ray.dir_z[lane] = static_cast<float>(r.direction.z()) + 0.0f;
    ray.tnear[lane] = 5e-7f;
    ray.time[lane] = 0.0f;
    ray.mask[lane] = ~0u;
    ray.id[lane] = ray.flags[lane] = 0;
    hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
  return packets;
}

/// Only what a packet needs to be traced again: the rest of it stays warm in the cache.
void TraceBare(RTCScene scene, std::vector<RTCRayHit16>& packets) {
  alignas(64) static const int valid[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  for (RTCRayHit16& packet : packets) {
    for (int i = 0; i < 16; ++i) {
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect16(valid, scene, &packet, &arguments);
#else
    rtcIntersect16(valid, scene, &context, &packet);
#endif
  }
}

/// Time that this process computed, whoever else keeps the machine busy.
double Seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Bare and exact by turns; each round gives a ratio, and the median of them forgets the rounds that were
/// disturbed.
void ExactAgainstBareEmbree(benchmark::State& state) {
  const Scene scene = MakeScene(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const RayBatch rays = Beams(scene);
  std::vector<RTCRayHit16> packets = Packets(rays);
  HitBatch hits;
  std::vector<double> bare_s, exact_s, ratio;
  for (auto _ : state) {
    const double a = Seconds();
    TraceBare(scene.embree_scene(), packets);
    const double b = Seconds();
    scene.Intersect(rays, hits);
    const double c = Seconds();
    bare_s.push_back(b - a);
    exact_s.push_back(c - b);
    ratio.push_back((b - a) / (c - b));
    benchmark::DoNotOptimize(hits.t_m.data());
  }
  state.counters["bare_Mray_s"] = kRays / Median(bare_s) * 1e-6;
  state.counters["exact_Mray_s"] = kRays / Median(exact_s) * 1e-6;
  state.counters["ratio"] = Median(ratio);
}
BENCHMARK(ExactAgainstBareEmbree)->Args({5, 0})->Args({20, 0})->Args({8, 100000});

void AnalyticNearest(benchmark::State& state) {
  const Scene scene = MakeScene(static_cast<int>(state.range(0)), 0);
  const RayBatch rays = Beams(scene);
  HitBatch hits;
  for (auto _ : state) scene.IntersectAnalytic(rays, hits);
  state.SetItemsProcessed(static_cast<std::int64_t>(kRays) * state.iterations());
}
BENCHMARK(AnalyticNearest)->Arg(5)->Arg(8)->Arg(20);

RotaryOpticsParameters Bench(BeamKind beam) {
  RotaryOpticsParameters p;
  p.nominal_wavelength_m = 650e-9;
  p.laser_position_m = {0.0, 0.2, 0.0};
  p.grating = {600e3, 0.025, 0.025, 1.0, {{0.0, {-2, {0.1, 0.339, 0.1, 0.339, 0.1}}}}};
  p.psd_a.distance_m = 0.120;
  p.psd_a.width_m = p.psd_a.height_m = 0.010;
  p.psd_b = p.psd_a;
  p.beam = {.kind = beam, .radius_m = 0.5e-3, .divergence_rad = 0.5e-3, .profile = {}};
  return p;
}

void FixedSequence(benchmark::State& state) {
  const RotaryOptics optics(Bench(BeamKind::kChiefRay));
  const Frame grating = MakeFrame(RectangularPlane(SurfacePoseOfGrating(Isometry3d::Identity()), 0.025, 0.025));
  const Frame plane = MakeFrame(RectangularPlane(optics.X_LA(), 0.01, 0.01));
  RayBatch rays;
  for (std::size_t i = 0; i < 1024; ++i) rays.Add({{1e-6 * static_cast<double>(i), 0.2, 0.0}, {0, -1, 0}});
  std::vector<double> u(1024), v(1024);
  for (auto _ : state) {
    TraceSequence(grating, 0.39, plane, rays, u.data(), v.data());
    benchmark::DoNotOptimize(u.data());
  }
  state.SetItemsProcessed(1024 * state.iterations());
}
BENCHMARK(FixedSequence);

void RotaryTrace(benchmark::State& state, const RotaryOpticsParameters& parameters) {
  const RotaryOptics optics(parameters);
  const SourceState source{650e-9, 1e-6, 2e-6, 5e-3};
  const Isometry3d X_LG(Eigen::AngleAxisd(1e-4, Vector3d(1, 2, 3).normalized()));
  for (auto _ : state) benchmark::DoNotOptimize(optics.Trace(X_LG, source));
}

void TraceChiefRay(benchmark::State& state) {
  RotaryTrace(state, Bench(BeamKind::kChiefRay));
}
BENCHMARK(TraceChiefRay);

void TraceGaussianBeam(benchmark::State& state) {
  RotaryTrace(state, Bench(BeamKind::kGaussian));
}
BENCHMARK(TraceGaussianBeam);

void TraceWindowsAndGhosts(benchmark::State& state) {
  RotaryOpticsParameters p = Bench(BeamKind::kGaussian);
  for (PsdParameters* psd : {&p.psd_a, &p.psd_b}) {
    psd->window = Window{1e-3, 1.51, 1e-3, 0.042, 0.0, false};
    psd->silicon_reflectance = 0.3;
  }
  RotaryTrace(state, p);
}
BENCHMARK(TraceWindowsAndGhosts);

}  // namespace
}  // namespace twinbench::optics

BENCHMARK_MAIN();
