#include "optics/embree_world.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace twinbench::optics {
namespace {

// Embree 4 renamed the context, moved the flag into an argument struct and dropped the instance's own filter field.
#if RTC_VERSION_MAJOR >= 4
struct Query {
  RTCIntersectArguments intersect;
  RTCOccludedArguments occluded;

  explicit Query(RayOrder order) {
    const auto flags = order == RayOrder::kCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcInitIntersectArguments(&intersect);
    rtcInitOccludedArguments(&occluded);
    intersect.flags = flags;
    occluded.flags = flags;
  }
  void Run(const int* valid, RTCScene scene, RTCRayHit16& packet) {
    rtcIntersect16(valid, scene, &packet, &intersect);
  }
  void Run(const int* valid, RTCScene scene, RTCRayHit8& packet) {
    rtcIntersect8(valid, scene, &packet, &intersect);
  }
  void Run(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect); }
  void Run(const int* valid, RTCScene scene, RTCRay16& packet) { rtcOccluded16(valid, scene, &packet, &occluded); }
  void Run(const int* valid, RTCScene scene, RTCRay8& packet) { rtcOccluded8(valid, scene, &packet, &occluded); }

  /// Embree 4 has no call for many packets.
  template <std::size_t kWidth, class Packet>
  void RunAll(RTCScene scene, Packet* packets, std::size_t count) {
    alignas(64) int valid[kWidth];
    std::fill_n(valid, kWidth, -1);
    for (std::size_t p = 0; p < count; ++p) Run(valid, scene, packets[p]);
  }
};

bool HasStreams(RTCDevice, int) {
  return false;
}
#else
struct Query {
  RTCIntersectContext context;

  explicit Query(RayOrder order) {
    rtcInitIntersectContext(&context);
    context.flags =
        order == RayOrder::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  void Run(const int* valid, RTCScene scene, RTCRayHit16& packet) {
    rtcIntersect16(valid, scene, &context, &packet);
  }
  void Run(const int* valid, RTCScene scene, RTCRayHit8& packet) { rtcIntersect8(valid, scene, &context, &packet); }
  void Run(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
  void Run(const int* valid, RTCScene scene, RTCRay16& packet) { rtcOccluded16(valid, scene, &context, &packet); }
  void Run(const int* valid, RTCScene scene, RTCRay8& packet) { rtcOccluded8(valid, scene, &context, &packet); }

  /// Packets of the processor's own width, every ray of them finite: coherent ones go down Embree's tree together.
  template <std::size_t kWidth, class Packet>
  void RunAll(RTCScene scene, Packet* packets, std::size_t count) {
    rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets), kWidth, static_cast<unsigned>(count),
                   sizeof(Packet));
  }
};

bool HasStreams(RTCDevice device, int width) {
  const auto native = width == 16 ? RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED
                                  : RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED;
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED) &&
         rtcGetDeviceProperty(device, native);
}
#endif

constexpr float kFar_m = 1e18f;  // Embree's own limit is a little above
/// Embree must not see a ray that is not finite: some builds of it stop the program.
/// @param strange  Set where a ray is not; kept lane by lane for several packets.
template <std::size_t kWidth, class RayPacket>
[[gnu::always_inline]] inline void ToFloat(ConstRays from, RayPacket& ray, int* __restrict strange) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    const float ox = static_cast<float>(from.ox[i]);
    const float oy = static_cast<float>(from.oy[i]);
    const float oz = static_cast<float>(from.oz[i]);
    // + 0 turns -0 into +0, so that the sign of a zero never sends a ray to another octant of Embree's packets.
    const float dx = static_cast<float>(from.dx[i]) + 0.0f;
    const float dy = static_cast<float>(from.dy[i]) + 0.0f;
    const float dz = static_cast<float>(from.dz[i]) + 0.0f;
    ray.org_x[i] = ox;
    ray.org_y[i] = oy;
    ray.org_z[i] = oz;
    ray.dir_x[i] = dx;
    ray.dir_y[i] = dy;
    ray.dir_z[i] = dz;
    const float size =
        std::abs(ox) + std::abs(oy) + std::abs(oz) + std::abs(dx) + std::abs(dy) + std::abs(dz);
    strange[i] |= size < kFar_m ? 0 : 1;
  }
}

/// Valid is -1, not valid 0.
template <std::size_t kWidth, class RayPacket>
[[gnu::always_inline]] inline void FindFinite(const RayPacket& ray, int* __restrict valid) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    const float size = std::abs(ray.org_x[i]) + std::abs(ray.org_y[i]) + std::abs(ray.org_z[i]) +
                       std::abs(ray.dir_x[i]) + std::abs(ray.dir_y[i]) + std::abs(ray.dir_z[i]);
    valid[i] = -static_cast<int>(size < kFar_m);
  }
}

/// What is the same for every ray.
template <std::size_t kWidth, class RayPacket>
[[gnu::always_inline]] inline void Prepare(RayPacket& ray) {
  std::fill_n(ray.time, kWidth, 0.0f);
  std::fill_n(ray.mask, kWidth, ~0u);
  std::fill_n(ray.id, kWidth, 0u);
  std::fill_n(ray.flags, kWidth, 0u);
}

template <std::size_t kWidth, class HitPacket>
[[gnu::always_inline]] inline void Forget(HitPacket& hit) {
  std::fill_n(hit.geomID, kWidth, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(hit.instID[0], kWidth, RTC_INVALID_GEOMETRY_ID);
}

template <std::size_t kWidth, class RayHitPacket>
[[gnu::always_inline]] inline void Read(const RayHitPacket& packet, RawAnswers answers) {
  std::copy_n(packet.hit.geomID, kWidth, answers.geometry);
  std::copy_n(packet.hit.primID, kWidth, answers.primitive);
  std::copy_n(packet.ray.tfar, kWidth, answers.t_m);
}

}  // namespace

/// What Embree leaves as it was, and what nobody reads, is written once for all rays.
template <std::size_t kWidth, class Packet>
[[gnu::always_inline]] inline void PrepareAll(Packet* packets, std::size_t count, float near_m) {
  for (std::size_t p = 0; p < count; ++p) {
    Prepare<kWidth>(packets[p].ray);
    std::fill_n(packets[p].ray.tnear, kWidth, near_m);
    Forget<kWidth>(packets[p].hit);
  }
}

/// How a tile is traced.
struct Tracing {
  RTCScene scene;
  Query& query;
  bool together;  // all its packets by one call
  float near_m;
};

template <std::size_t kWidth, class Packet>
[[gnu::always_inline]] inline void RunOneByOne(const Tracing& tracing, Packet* packets, std::size_t count) {
  alignas(64) int valid[kWidth];
  for (std::size_t p = 0; p < count; ++p) {
    FindFinite<kWidth>(packets[p].ray, valid);
    tracing.query.Run(valid, tracing.scene, packets[p]);
  }
}

// All packets are filled, then traced, then read: so no load waits for the store of a moment ago.
template <std::size_t kWidth, class Packet>
[[gnu::always_inline]] inline void IntersectTogether(const Tracing& tracing, ConstRays r, Packet* packets,
                                                 std::size_t count, RawAnswers answers) {
  alignas(64) int strange[kWidth] = {};
  for (std::size_t p = 0; p < count; ++p) {
    ToFloat<kWidth>(r.From(p * kWidth), packets[p].ray, strange);
    std::fill_n(packets[p].ray.tfar, kWidth, std::numeric_limits<float>::infinity());
    std::fill_n(packets[p].hit.geomID, kWidth, RTC_INVALID_GEOMETRY_ID);
  }
  int any_strange = 0;
  for (std::size_t i = 0; i < kWidth; ++i) any_strange |= strange[i];
  if (tracing.together && any_strange == 0) {
    tracing.query.template RunAll<kWidth>(tracing.scene, packets, count);
  } else {
    RunOneByOne<kWidth>(tracing, packets, count);
  }
  for (std::size_t p = 0; p < count; ++p) Read<kWidth>(packets[p], answers.From(p * kWidth));
}

template <std::size_t kWidth, class Packet>
[[gnu::always_inline]] inline void IntersectPackets(const Tracing& tracing, const RayBatch& rays,
                                                    std::size_t packets, const EmbreeWorld::Tile& tile) {
  constexpr std::size_t kTile = kTileRays / kWidth;
  alignas(64) unsigned geometry[kTileRays];
  alignas(64) unsigned primitive[kTileRays];
  alignas(64) float t_m[kTileRays];
  const RawAnswers answers{geometry, primitive, t_m};
  Packet storage[kTogether];
  PrepareAll<kWidth>(storage, std::min(packets, kTogether), tracing.near_m);
  for (std::size_t p = 0; p < packets; p += kTile) {
    const std::size_t count = std::min(kTile, packets - p);
    for (std::size_t k = 0; k < count; k += kTogether) {
      IntersectTogether<kWidth>(tracing, From(rays, (p + k) * kWidth), storage, std::min(kTogether, count - k),
                                answers.From(k * kWidth));
    }
    tile(p * kWidth, count, answers);
  }
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void IntersectPackets16(const Tracing& tracing,
                                                                             const RayBatch& rays,
                                                                             std::size_t packets,
                                                                             const EmbreeWorld::Tile& tile) {
  IntersectPackets<16, RTCRayHit16>(tracing, rays, packets, tile);
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void IntersectPackets8(const Tracing& tracing,
                                                                            const RayBatch& rays,
                                                                            std::size_t packets,
                                                                            const EmbreeWorld::Tile& tile) {
  IntersectPackets<8, RTCRayHit8>(tracing, rays, packets, tile);
}

namespace {

template <std::size_t kWidth, class RayPacket>
void Fill(const RayBatch& rays, std::size_t begin, std::size_t n, const Bounds& bounds, RayPacket& ray,
          int* valid) {
  const ConstRays from = From(rays, begin);
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    // Lanes without a ray copy the first one: what they hold by chance (NaN) is none of Embree's business.
    const std::size_t i = lane < n ? lane : 0;
    ray.org_x[lane] = static_cast<float>(from.ox[i]) + 0.0f;
    ray.org_y[lane] = static_cast<float>(from.oy[i]) + 0.0f;
    ray.org_z[lane] = static_cast<float>(from.oz[i]) + 0.0f;
    ray.dir_x[lane] = static_cast<float>(from.dx[i]) + 0.0f;
    ray.dir_y[lane] = static_cast<float>(from.dy[i]) + 0.0f;
    ray.dir_z[lane] = static_cast<float>(from.dz[i]) + 0.0f;
  }
  Prepare<kWidth>(ray);
  std::copy_n(bounds.near_m, kWidth, ray.tnear);
  std::copy_n(bounds.far_m, kWidth, ray.tfar);
  FindFinite<kWidth>(ray, valid);
  for (std::size_t lane = 0; lane < kWidth; ++lane) valid[lane] &= bounds.valid[lane];
}

template <std::size_t kWidth, class Packet>
void IntersectPacket(RTCScene scene, const RayBatch& rays, std::size_t begin, std::size_t n, RayOrder order,
                     const Bounds& bounds, Answers answers) {
  Packet packet;
  alignas(64) int valid[kWidth];
  Fill<kWidth>(rays, begin, n, bounds, packet.ray, valid);
  Forget<kWidth>(packet.hit);
  Query(order).Run(valid, scene, packet);
  Name({packet.hit.geomID, packet.hit.primID, packet.ray.tfar}, kWidth, answers);
}

template <std::size_t kWidth, class Packet>
void OccludedPacket(RTCScene scene, const RayBatch& rays, std::size_t begin, std::size_t n, const Bounds& bounds,
                    Answers answers) {
  Packet packet;
  alignas(64) int valid[kWidth];
  Fill<kWidth>(rays, begin, n, bounds, packet, valid);
  // Never coherent: Embree 3.13's coherent shadow packets can loop for ever on axis-parallel rays. One packet, bit
  // by bit the same and every lane of it filled, hangs in one run of a program and not in the next.
  Query(RayOrder::kScattered).Run(valid, scene, packet);
  for (std::size_t i = 0; i < kWidth; ++i) answers.triangle[i] = packet.tfar[i] < 0.0f ? kFixture : kNothing;
}

/// Copies a mesh into buffers that Embree owns and pads.
void FillBuffers(RTCGeometry geometry, const TriangleMesh& mesh, bool with_triangles) {
  auto* vertices = static_cast<float*>(
      with_triangles ? rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                               3 * sizeof(float), mesh.vertices_m.size())
                     : rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) {
    for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(vertex(axis));
  }
  if (!with_triangles) return rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) *indices++ = index;
  }
}

RTCGeometry MakeTriangles(RTCDevice device, const TriangleMesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  FillBuffers(geometry, mesh, true);
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace

EmbreeWorld::EmbreeWorld(const std::string& options)
    : EmbreeWorld(rtcNewDevice(("threads=1,set_affinity=0," + options).c_str())) {
  rtcReleaseDevice(device_);  // this world holds it now
}

EmbreeWorld::EmbreeWorld(RTCDeviceTy* device) : device_(device) {
  if (!device_)
    throw std::runtime_error("Embree: no device (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcRetainDevice(device_);
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
  fixtures_ = rtcNewScene(device_);
  rtcSetSceneFlags(fixtures_, RTC_SCENE_FLAG_DYNAMIC);
  if (!rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) packet_width_ = 8;
  has_streams_ = HasStreams(device_, packet_width_);
}

EmbreeWorld::~EmbreeWorld() {
  rtcReleaseScene(scene_);
  rtcReleaseScene(fixtures_);
  for (const Instance& instance : instances_) {
    rtcReleaseGeometry(instance.geometry);
    rtcReleaseScene(instance.scene);
  }
  if (proxies_) rtcReleaseGeometry(proxies_);
  rtcReleaseDevice(device_);
}

void EmbreeWorld::AddMesh(const TriangleMesh& mesh) {
  RTCScene inner = rtcNewScene(device_);
  RTCGeometry triangles = MakeTriangles(device_, mesh);
  rtcAttachGeometryByID(inner, triangles, kMeshGeometry);
  rtcReleaseGeometry(triangles);
  rtcCommitScene(inner);
  RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, inner);
  const auto id = static_cast<unsigned>(instances_.size()) + kProxyGeometry + 1;
  rtcAttachGeometryByID(scene_, instance, id);
  rtcAttachGeometryByID(fixtures_, instance, id);
  instances_.push_back({inner, instance});
}

void EmbreeWorld::SetMeshPose(int index, const Eigen::Isometry3d& X_WM) {
  const Eigen::Matrix<float, 3, 4, Eigen::ColMajor> transform = X_WM.matrix().topRows<3>().cast<float>();
  RTCGeometry geometry = instances_[static_cast<std::size_t>(index)].geometry;
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
  rtcCommitGeometry(geometry);
}

void EmbreeWorld::SetProxies(const TriangleMesh& proxies, bool same_topology) {
  if (proxies.triangles.empty()) return;
  if (proxies_) {
    FillBuffers(proxies_, proxies, !same_topology);
    return rtcCommitGeometry(proxies_);
  }
  proxies_ = MakeTriangles(device_, proxies);
  rtcAttachGeometryByID(scene_, proxies_, kProxyGeometry);
}

void EmbreeWorld::Commit() {
  rtcCommitScene(scene_);
  rtcCommitScene(fixtures_);
  const RTCError error = rtcGetDeviceError(device_);
  if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree: error " + std::to_string(error) + " in a scene");
}

void EmbreeWorld::Intersect(const RayBatch& rays, std::size_t packets, float near_m, RayOrder order,
                            const Tile& tile) const {
  Query query(order);
  const auto trace = packet_width_ == 16 ? IntersectPackets16 : IntersectPackets8;
  trace({scene_, query, has_streams_ && order == RayOrder::kCoherent, near_m}, rays, packets, tile);
}

Answer EmbreeWorld::Intersect(const Ray& ray, float near_m, float far_m) const {
  const Eigen::Vector3f o = ray.origin_m.cast<float>(), d = ray.direction.cast<float>();
  if (!(o.cwiseAbs().sum() + d.cwiseAbs().sum() < kFar_m)) return {};  // as FindFinite
  RTCRayHit one{};
  one.ray.org_x = o.x() + 0.0f, one.ray.org_y = o.y() + 0.0f, one.ray.org_z = o.z() + 0.0f;
  one.ray.dir_x = d.x() + 0.0f, one.ray.dir_y = d.y() + 0.0f, one.ray.dir_z = d.z() + 0.0f;
  one.ray.tnear = near_m;
  one.ray.tfar = far_m;
  one.ray.mask = ~0u;
  one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  Query(RayOrder::kCoherent).Run(scene_, one);
  if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {one.hit.geomID == kProxyGeometry ? static_cast<int>(one.hit.primID) : kFixture, one.ray.tfar};
}

void EmbreeWorld::Intersect(const RayBatch& rays, std::size_t begin, std::size_t n, RayOrder order,
                            const Bounds& bounds, Answers answers) const {
  const auto trace = packet_width_ == 16 ? IntersectPacket<16, RTCRayHit16> : IntersectPacket<8, RTCRayHit8>;
  trace(scene_, rays, begin, n, order, bounds, answers);
}

void EmbreeWorld::Occluded(const RayBatch& rays, std::size_t begin, std::size_t n, const Bounds& bounds,
                           Answers answers) const {
  const auto trace = packet_width_ == 16 ? OccludedPacket<16, RTCRay16> : OccludedPacket<8, RTCRay8>;
  trace(fixtures_, rays, begin, n, bounds, answers);
}

}  // namespace twinbench::optics
