#include "optics/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "optics/embree_world.h"
#include "optics/kernels.h"

namespace twinbench::optics {
namespace {

constexpr float kNear = static_cast<float>(0.5 * Scene::t_min_m);

struct alignas(64) Storage {
  int triangle[kMaxPacket];
  float t_m[kMaxPacket];

  Answers View() { return {triangle, t_m}; }
};

Bounds WholeRays(std::size_t n) {
  Bounds bounds;
  std::fill_n(bounds.valid, n, -1);
  std::fill(bounds.valid + n, bounds.valid + kMaxPacket, 0);
  std::fill_n(bounds.near_m, kMaxPacket, kNear);
  std::fill_n(bounds.far_m, kMaxPacket, std::numeric_limits<float>::infinity());
  return bounds;
}

/// Distance along a ray below which float cannot tell two things apart, for a scene of this extent.
double FloatBlur(double extent_m) {
  return 1e-6 + 1e-6 * extent_m;
}

/// Where to go on behind a proxy at t that deceived: at least a few float steps, or a far one would be found again
/// and again.
float Behind(float t_m, float blur_m) {
  return t_m * (1.0f + 4.0f * std::numeric_limits<float>::epsilon()) + blur_m;
}

Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) box.extend(vertex);
  return box;
}

void Append(const TriangleMesh& from, TriangleMesh& to) {
  const auto offset = static_cast<std::uint32_t>(to.vertices_m.size());
  to.vertices_m.insert(to.vertices_m.end(), from.vertices_m.begin(), from.vertices_m.end());
  for (const auto& [a, b, c] : from.triangles) to.triangles.push_back({a + offset, b + offset, c + offset});
}

/// Few small numbers, each once.
struct SmallSet {
  std::array<int, kMaxPacket> item;
  int size = 0;

  bool Insert(int value) {
    for (int i = 0; i < size; ++i) {
      if (item[static_cast<std::size_t>(i)] == value) return false;
    }
    item[static_cast<std::size_t>(size++)] = value;
    return true;
  }
};

}  // namespace

struct Scene::Impl {
  explicit Impl(const std::string& embree_options) : world(embree_options) {}
  explicit Impl(RTCDeviceTy* device) : world(device) {}

  std::vector<Surface> surfaces;
  std::vector<Target> targets;  // as many
  std::vector<int> surface_of_triangle;
  std::vector<std::vector<int>> neighbours;  // of each surface: those whose proxies' boxes touch its own
  std::vector<TriangleMesh> meshes;
  std::vector<Eigen::Isometry3d> mesh_poses;
  EmbreeWorld world;
  float blur_m = 0.0f;
  bool committed = false;
  bool same_topology = false;
  mutable std::atomic<std::uint64_t> rays_traced{0};

  void CommitProxies();
  void FindNeighbours(const std::vector<Eigen::AlignedBox3d>& boxes);
  double Extent() const;
  void Settle(const RayBatch& rays, std::size_t begin, std::size_t packets, RayOrder order, RawAnswers answers,
              HitBatch& hits) const;
  void IntersectLast(const RayBatch& rays, std::size_t begin, RayOrder order, HitBatch& hits) const;
  void Pursue(const RayBatch& rays, std::size_t begin, std::size_t n, RayOrder order, Answers answers,
              HitBatch& hits) const;
  void Refine(const RayBatch& rays, std::size_t begin, std::size_t n, Answers answers, HitBatch& hits) const;
  void Refine(const Ray& ray, int triangle, NearestHit& nearest) const;
  bool Continue(std::size_t begin, std::size_t n, Answers answers, const HitBatch& hits, Bounds& bounds) const;
  void TakeSurfaces(const RayBatch& rays, HitBatch& hits) const;
  void Shadow(const RayBatch& rays, std::size_t begin, std::size_t n, HitBatch& hits) const;
};

double Scene::Impl::Extent() const {
  double extent = 0.0;
  for (const Surface& s : surfaces) {
    extent = std::max(extent, s.X_WS.translation().norm() + std::hypot(s.half_x_m, s.half_y_m));
  }
  return extent;
}

void Scene::Impl::CommitProxies() {
  blur_m = static_cast<float>(FloatBlur(Extent()));
  TriangleMesh proxies;
  std::vector<Eigen::AlignedBox3d> boxes;
  surface_of_triangle.clear();
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const TriangleMesh proxy = ProxyOf(surfaces[i], 5.0 * blur_m);
    boxes.push_back(BoundsOf(proxy));
    targets[i].triangles.first = static_cast<int>(surface_of_triangle.size());
    surface_of_triangle.resize(surface_of_triangle.size() + proxy.triangles.size(), static_cast<int>(i));
    targets[i].triangles.end = static_cast<int>(surface_of_triangle.size());
    Append(proxy, proxies);
  }
  world.SetProxies(proxies, same_topology);
  same_topology = true;
  FindNeighbours(boxes);
}

void Scene::Impl::FindNeighbours(const std::vector<Eigen::AlignedBox3d>& boxes) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(2.0 * blur_m);
  neighbours.assign(boxes.size(), {});
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Eigen::AlignedBox3d wide(boxes[i].min() - margin, boxes[i].max() + margin);
    for (std::size_t j = 0; j < boxes.size(); ++j) {
      if (i != j && wide.intersects(boxes[j])) neighbours[i].push_back(static_cast<int>(j));
    }
    targets[i].alone = surfaces[i].curvature_per_m == 0.0 && neighbours[i].empty();
  }
}

/// Recomputes in double every surface that Embree named, and those too close to it to be told apart in float.
/// Testing a surface against all rays of the packet is harmless: the nearest true hit wins.
void Scene::Impl::Refine(const RayBatch& rays, std::size_t begin, std::size_t n, Answers answers,
                         HitBatch& hits) const {
  SmallSet done;
  int last = kNothing;
  for (std::size_t i = 0; i < n; ++i) {
    const int triangle = answers.triangle[i];
    if (triangle < 0 || triangle == last) continue;
    last = triangle;
    const int surface = surface_of_triangle[static_cast<std::size_t>(triangle)];
    if (!done.Insert(surface)) continue;
    TakeNearest(targets[static_cast<std::size_t>(surface)].frame, surface, rays, begin, n, t_min_m, hits);
    for (const int other : neighbours[static_cast<std::size_t>(surface)]) {
      TakeNearest(targets[static_cast<std::size_t>(other)].frame, other, rays, begin, n, t_min_m, hits);
    }
  }
}

void Scene::Impl::Refine(const Ray& ray, int triangle, NearestHit& nearest) const {
  const auto take = [&](int surface) {
    const SurfaceHit hit = Meet(targets[static_cast<std::size_t>(surface)].frame, ray, t_min_m);
    const bool first = surface < nearest.index && hit.t_m == nearest.hit.t_m;
    if (hit.t_m < nearest.hit.t_m || (first && std::isfinite(hit.t_m))) nearest = {surface, hit};
  };
  const int named = surface_of_triangle[static_cast<std::size_t>(triangle)];
  take(named);
  for (const int other : neighbours[static_cast<std::size_t>(named)]) take(other);
}

/// Closes the lanes whose answer is final; the others go on behind the proxy that deceived them.
bool Scene::Impl::Continue(std::size_t begin, std::size_t n, Answers answers, const HitBatch& hits,
                           Bounds& bounds) const {
  bool any = false;
  for (std::size_t i = 0; i < n; ++i) {
    const float t = answers.t_m[i];
    const double best = hits.t_m[begin + i];
    const bool settled = !bounds.valid[i] || answers.triangle[i] < 0 || best <= static_cast<double>(t) + blur_m;
    bounds.valid[i] = settled ? 0 : -1;
    bounds.near_m[i] = Behind(t, blur_m);
    bounds.far_m[i] = static_cast<float>(best) + blur_m;
    any |= !settled;
  }
  return any;
}

/// Decides one packet from Embree's first answers, however many surfaces it takes.
void Scene::Impl::Pursue(const RayBatch& rays, std::size_t begin, std::size_t n, RayOrder order, Answers answers,
                         HitBatch& hits) const {
  hits.Clear(begin, n);
  Refine(rays, begin, n, answers, hits);
  if (!Compare(answers, blur_m, begin, n, hits)) return;
  Bounds bounds = WholeRays(n);
  while (Continue(begin, n, answers, hits, bounds)) {
    world.Intersect(rays, begin, n, order, bounds, answers);
    Refine(rays, begin, n, answers, hits);
    Compare(answers, blur_m, begin, n, hits);
  }
}

/// Decides a tile of whole packets: those on one lone plane together, for there beams are; the others one by one.
void Scene::Impl::Settle(const RayBatch& rays, std::size_t begin, std::size_t packets, RayOrder order,
                         RawAnswers answers, HitBatch& hits) const {
  const auto width = static_cast<std::size_t>(world.packet_width());
  const Targets table{targets.data(), surface_of_triangle.data(), blur_m};
  std::uint32_t unsettled = SettlePlanes(table, rays, begin, packets * width, width, answers, t_min_m, hits);
  for (; unsettled != 0; unsettled &= unsettled - 1) {
    const std::size_t i = static_cast<std::size_t>(std::countr_zero(unsettled)) * width;
    Storage storage;
    Name(answers.From(i), width, storage.View());
    Pursue(rays, begin + i, width, order, storage.View(), hits);
  }
}

/// The rest, less than a packet.
void Scene::Impl::IntersectLast(const RayBatch& rays, std::size_t begin, RayOrder order, HitBatch& hits) const {
  const std::size_t n = rays.size() - begin;
  Storage storage;
  world.Intersect(rays, begin, n, order, WholeRays(n), storage.View());
  Pursue(rays, begin, n, order, storage.View(), hits);
}

void Scene::Impl::TakeSurfaces(const RayBatch& rays, HitBatch& hits) const {
  constexpr std::size_t kTile = 256;  // stays in the first-level cache while every surface passes over it
  for (std::size_t begin = 0; begin < rays.size(); begin += kTile) {
    const std::size_t n = std::min(kTile, rays.size() - begin);
    for (std::size_t s = 0; s < targets.size(); ++s) {
      TakeNearest(targets[s].frame, static_cast<int>(s), rays, begin, n, t_min_m, hits);
    }
  }
}

void Scene::Impl::Shadow(const RayBatch& rays, std::size_t begin, std::size_t n, HitBatch& hits) const {
  Bounds bounds = WholeRays(n);
  std::fill_n(bounds.near_m, n, static_cast<float>(t_min_m));
  for (std::size_t i = 0; i < n; ++i) bounds.far_m[i] = static_cast<float>(hits.t_m[begin + i]);
  Storage storage;
  const Answers answers = storage.View();
  world.Occluded(rays, begin, n, bounds, answers);
  for (std::size_t i = 0; i < n; ++i) {
    if (answers.triangle[i] != kFixture) continue;
    hits.surface[begin + i] = kFixture;
    hits.t_m[begin + i] = std::numeric_limits<double>::quiet_NaN();
  }
}

Scene::Scene(const std::string& embree_options) : impl_(std::make_unique<Impl>(embree_options)) {}
Scene::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Scene Scene::OnDeviceOf(const Scene& other) {
  return Scene(std::make_unique<Impl>(other.impl_->world.device()));
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

int Scene::AddSurface(const Surface& surface) {
  Validate(surface);
  impl_->surfaces.push_back(surface);
  impl_->targets.push_back({MakeFrame(surface), {}, false});
  impl_->committed = impl_->same_topology = false;
  return static_cast<int>(impl_->surfaces.size()) - 1;
}

int Scene::AddMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& X_WM) {
  Validate(mesh);
  impl_->meshes.push_back(mesh);
  impl_->mesh_poses.push_back(X_WM);
  impl_->world.AddMesh(mesh);
  const int index = static_cast<int>(impl_->meshes.size()) - 1;
  SetMeshPose(index, X_WM);
  return index;
}

void Scene::SetSurfacePose(int index, const Eigen::Isometry3d& X_WS) {
  Surface& surface = impl_->surfaces.at(static_cast<std::size_t>(index));
  surface.X_WS = X_WS;
  Validate(surface);
  impl_->targets[static_cast<std::size_t>(index)].frame = MakeFrame(surface);
  impl_->committed = false;
}

void Scene::SetMeshPose(int index, const Eigen::Isometry3d& X_WM) {
  impl_->mesh_poses.at(static_cast<std::size_t>(index)) = X_WM;
  impl_->world.SetMeshPose(index, X_WM);
  impl_->committed = false;
}

void Scene::Commit() {
  impl_->CommitProxies();
  impl_->world.Commit();
  impl_->committed = true;
}

const std::vector<Surface>& Scene::surfaces() const {
  return impl_->surfaces;
}
std::uint64_t Scene::rays_traced() const {
  return impl_->rays_traced;
}
int Scene::packet_width() const {
  return impl_->world.packet_width();
}
RTCSceneTy* Scene::embree_scene() const {
  return impl_->world.scene();
}

void Scene::Intersect(const RayBatch& rays, HitBatch& hits, RayOrder order) const {
  if (!impl_->committed) throw std::logic_error("Scene::Intersect before Commit");
  hits.Resize(rays.size());
  impl_->rays_traced.fetch_add(rays.size(), std::memory_order_relaxed);
  const auto width = static_cast<std::size_t>(packet_width());
  const std::size_t packets = rays.size() / width;
  impl_->world.Intersect(rays, packets, kNear, order, [&](std::size_t begin, std::size_t count, RawAnswers answers) {
    impl_->Settle(rays, begin, count, order, answers, hits);
  });
  if (packets * width < rays.size()) impl_->IntersectLast(rays, packets * width, order, hits);
}

NearestHit Scene::First(const Ray& ray) const {
  if (!impl_->committed) throw std::logic_error("Scene::First before Commit");
  impl_->rays_traced.fetch_add(1, std::memory_order_relaxed);
  NearestHit nearest;
  float near_m = kNear;
  while (true) {
    const Answer answer = impl_->world.Intersect(ray, near_m, static_cast<float>(nearest.hit.t_m) + impl_->blur_m);
    if (answer.triangle == kNothing) return nearest;
    if (answer.triangle >= 0) impl_->Refine(ray, answer.triangle, nearest);
    if (answer.triangle == kFixture && answer.t_m < nearest.hit.t_m) nearest = {kFixture, {.t_m = answer.t_m}};
    if (nearest.hit.t_m <= static_cast<double>(answer.t_m) + impl_->blur_m) return nearest;
    near_m = Behind(answer.t_m, impl_->blur_m);
  }
}

void Scene::IntersectAnalytic(const RayBatch& rays, HitBatch& hits) const {
  hits.Reset(rays.size());
  impl_->TakeSurfaces(rays, hits);
  for (std::size_t m = 0; m < impl_->meshes.size(); ++m) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double t = MeetMesh(impl_->meshes[m], impl_->mesh_poses[m], rays.At(i), t_min_m);
      if (!(t < hits.t_m[i])) continue;
      hits.surface[i] = kFixture;
      hits.t_m[i] = t;
    }
  }
}

bool Scene::Occluded(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const {
  RayBatch ray;
  ray.Add({from_m, (to_m - from_m).normalized()});
  HitBatch hits;
  hits.Reset(1);
  hits.t_m[0] = (to_m - from_m).norm() - t_min_m;
  impl_->Shadow(ray, 0, 1, hits);
  return hits.surface[0] == kFixture;
}

}  // namespace twinbench::optics
