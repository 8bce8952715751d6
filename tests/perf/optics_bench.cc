// What does exactness cost? Bare Embree packets against the same rays with every hit recomputed in double.
// The arguments are the number of surfaces and of mesh triangles; avx2: Embree as it runs without AVX-512.
// Run: bench_optics --benchmark_min_time=0.5

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "optics/bench.h"
#include "tests/perf/timing.h"

namespace twinbench::optics {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d, perf::Median, perf::Seconds;

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

Scene MakeScene(int surfaces, int triangles, const std::string& embree_options = "") {
  Scene scene(embree_options);
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

template <std::size_t kWidth, class Packet>
std::vector<Packet> Packets(const RayBatch& rays) {
  std::vector<Packet> packets(rays.size() / kWidth);
  for (std::size_t i = 0; i < packets.size() * kWidth; ++i) {
    auto& [ray, hit] = packets[i / kWidth];
    const std::size_t lane = i % kWidth;
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

#if RTC_VERSION_MAJOR >= 4
struct Coherent {
  RTCIntersectArguments arguments;
  Coherent() {
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
  void Run(const int* valid, RTCScene scene, RTCRayHit8& p) { rtcIntersect8(valid, scene, &p, &arguments); }
  void Run(const int* valid, RTCScene scene, RTCRayHit16& p) { rtcIntersect16(valid, scene, &p, &arguments); }
};
#else
struct Coherent {
  RTCIntersectContext context;
  Coherent() {
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  void Run(const int* valid, RTCScene scene, RTCRayHit8& p) { rtcIntersect8(valid, scene, &context, &p); }
  void Run(const int* valid, RTCScene scene, RTCRayHit16& p) { rtcIntersect16(valid, scene, &context, &p); }
};
#endif

/// Only what a packet needs to be traced again: the rest of it stays warm in the cache.
template <std::size_t kWidth, class Packet>
void TraceBare(RTCScene scene, std::vector<Packet>& packets) {
  alignas(64) int valid[kWidth];
  std::fill_n(valid, kWidth, -1);
  Coherent query;
  for (Packet& packet : packets) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    query.Run(valid, scene, packet);
  }
}

/// Bare and exact by turns; each round gives a ratio to the better of the two bare packets, and the median of them
/// forgets the rounds that were disturbed.
void ExactAgainstBareEmbree(benchmark::State& state, const std::string& embree_options) {
  const Scene scene = MakeScene(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), embree_options);
  const RayBatch rays = Beams(scene);
  auto packets8 = Packets<8, RTCRayHit8>(rays);
  auto packets16 = Packets<16, RTCRayHit16>(rays);
  HitBatch hits;
  std::vector<double> bare8_s, bare16_s, exact_s, ratio;
  for (auto _ : state) {
    const double a = Seconds();
    TraceBare<8>(scene.embree_scene(), packets8);
    const double b = Seconds();
    TraceBare<16>(scene.embree_scene(), packets16);
    const double c = Seconds();
    scene.Intersect(rays, hits);
    const double d = Seconds();
    bare8_s.push_back(b - a);
    bare16_s.push_back(c - b);
    exact_s.push_back(d - c);
    ratio.push_back(std::min(b - a, c - b) / (d - c));
    benchmark::DoNotOptimize(hits.t_m.data());
  }
  state.counters["bare8_Mray_s"] = kRays / Median(bare8_s) * 1e-6;
  state.counters["bare16_Mray_s"] = kRays / Median(bare16_s) * 1e-6;
  state.counters["exact_Mray_s"] = kRays / Median(exact_s) * 1e-6;
  state.counters["ratio"] = Median(ratio);
}
BENCHMARK_CAPTURE(ExactAgainstBareEmbree, native, "")->Args({5, 0})->Args({20, 0})->Args({8, 100000});
BENCHMARK_CAPTURE(ExactAgainstBareEmbree, avx2, "max_isa=avx2")->Args({5, 0})->Args({20, 0})->Args({8, 100000});

RotaryOpticsParameters Bench(BeamKind beam) {
  RotaryOpticsParameters p;
  p.nominal_wavelength_m = 650e-9;
  p.laser_position_m = {0.0, 0.2, 0.0};
  p.grating = {600e3, 0.025, 0.025, 1.0, {{0.0, {-2, {0.1, 0.339, 0.1, 0.339, 0.1}}}}, {}};
  p.psd_a.distance_m = 0.120;
  p.psd_a.width_m = p.psd_a.height_m = 0.010;
  p.psd_b = p.psd_a;
  p.beam = {.kind = beam, .radius_m = 0.5e-3, .divergence_rad = 0.5e-3, .profile = {}};
  return p;
}

/// Traced and closed by turns: one reading of both orders.
void TracedAgainstClosed(benchmark::State& state, RotaryOpticsParameters parameters) {
  const RotaryOptics traced(parameters);
  parameters.fidelity = Fidelity::kClosed;
  const RotaryOptics closed(parameters);
  const SourceState source{650e-9, 1e-6, 2e-6, 5e-3};
  const Isometry3d X_LG(Eigen::AngleAxisd(1e-4, Vector3d(1, 2, 3).normalized()));
  constexpr int kReadings = 100;
  std::vector<double> traced_s, closed_s;
  for (auto _ : state) {
    const double a = Seconds();
    for (int i = 0; i < kReadings; ++i) benchmark::DoNotOptimize(traced.Trace(X_LG, source));
    const double b = Seconds();
    for (int i = 0; i < kReadings; ++i) benchmark::DoNotOptimize(closed.Trace(X_LG, source));
    const double c = Seconds();
    traced_s.push_back(b - a);
    closed_s.push_back(c - b);
  }
  state.counters["traced_us"] = Median(traced_s) / kReadings * 1e6;
  state.counters["closed_us"] = Median(closed_s) / kReadings * 1e6;
}
BENCHMARK_CAPTURE(TracedAgainstClosed, chief_ray, Bench(BeamKind::kChiefRay));
BENCHMARK_CAPTURE(TracedAgainstClosed, gaussian, Bench(BeamKind::kGaussian));

RotaryOpticsParameters WithWindowsAndGhosts() {
  RotaryOpticsParameters p = Bench(BeamKind::kGaussian);
  for (PsdParameters* psd : {&p.psd_a, &p.psd_b}) {
    psd->window = Window{1e-3, 1.51, 1e-3, 0.042, 0.0, false};
    psd->silicon_reflectance = 0.3;
  }
  return p;
}
BENCHMARK_CAPTURE(TracedAgainstClosed, windows_and_ghosts, WithWindowsAndGhosts());

/// A measured beam of n x n pixels.
void TraceMeasuredBeam(benchmark::State& state) {
  RotaryOpticsParameters p = Bench(BeamKind::kProfile);
  IrradianceMap map;
  map.width = map.height = static_cast<int>(state.range(0));
  map.pitch_m = 2e-3 / map.width;
  map.irradiance_W_m2.assign(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), 1.0f);
  p.beam.profile = map;
  p.beam.divergence_rad = 0.0;
  const RotaryOptics optics(p);
  const Isometry3d X_LG(Eigen::AngleAxisd(1e-4, Vector3d(1, 2, 3).normalized()));
  for (auto _ : state) benchmark::DoNotOptimize(optics.Trace(X_LG, {650e-9, 1e-6, 2e-6, 5e-3}));
}
BENCHMARK(TraceMeasuredBeam)->Arg(1)->Arg(4)->Arg(16)->Arg(128);

/// The chief rays of many readings in packets: time a reading.
void TraceManyReadings(benchmark::State& state) {
  const RotaryOptics optics(Bench(BeamKind::kChiefRay));
  constexpr std::size_t kReadings = 628;
  const std::vector<SourceState> sources(kReadings, SourceState{650e-9, 1e-6, 2e-6, 5e-3});
  std::vector<Isometry3d> poses;
  for (std::size_t k = 0; k < kReadings; ++k)
    poses.emplace_back(Eigen::AngleAxisd(1e-6 * static_cast<double>(k), Vector3d(1, 2, 3).normalized()));
  for (auto _ : state) benchmark::DoNotOptimize(optics.Trace(poses, sources));
  state.SetItemsProcessed(static_cast<std::int64_t>(kReadings) * state.iterations());
}
BENCHMARK(TraceManyReadings);

/// What a twin pays once for its traced light: Embree's device and two scenes.
void MakeTracedLight(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(RotaryOptics(Bench(BeamKind::kChiefRay)));
}
BENCHMARK(MakeTracedLight);

}  // namespace
}  // namespace twinbench::optics

BENCHMARK_MAIN();
