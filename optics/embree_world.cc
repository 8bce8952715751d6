#include "optics/embree_world.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "optics/kernels.h"

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
  void Run(const int* valid, RTCScene scene, RTCRay16& packet) { rtcOccluded16(valid, scene, &packet, &occluded); }
  void Run(const int* valid, RTCScene scene, RTCRay8& packet) { rtcOccluded8(valid, scene, &packet, &occluded); }
};
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
  void Run(const int* valid, RTCScene scene, RTCRay16& packet) { rtcOccluded16(valid, scene, &context, &packet); }
  void Run(const int* valid, RTCScene scene, RTCRay8& packet) { rtcOccluded8(valid, scene, &context, &packet); }
};
#endif

RTCRay16& RayPart(RTCRayHit16& packet) {
  return packet.ray;
}
RTCRay8& RayPart(RTCRayHit8& packet) {
  return packet.ray;
}
RTCRay16& RayPart(RTCRay16& packet) {
  return packet;
}
RTCRay8& RayPart(RTCRay8& packet) {
  return packet;
}

template <int kWidth, class Packet>
void Fill(const RayBatch& rays, std::size_t begin, std::size_t n, const Lanes& lanes, Packet& packet) {
  auto& ray = RayPart(packet);
  const std::array<float*, 6> lines{ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z};
  ToFloat(rays, begin, n, lines);
  // Inactive lanes copy the first one: what they hold by chance (NaN) is none of Embree's business.
  for (float* line : lines) std::fill(line + n, line + kWidth, line[0]);
  for (int i = 0; i < kWidth; ++i) {
    ray.tnear[i] = lanes.near_m[i];
    ray.tfar[i] = lanes.far_m[i];
    ray.time[i] = 0.0f;
    ray.mask[i] = ~0u;
    ray.id[i] = 0;
    ray.flags[i] = 0;
  }
}

template <int kWidth, class Packet>
void IntersectPacket(RTCScene scene, const RayBatch& rays, std::size_t begin, std::size_t n, RayOrder order,
                     Lanes& lanes) {
  Packet packet;
  Fill<kWidth>(rays, begin, n, lanes, packet);
  for (int i = 0; i < kWidth; ++i) {
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  Query(order).Run(lanes.valid, scene, packet);
  for (int i = 0; i < kWidth; ++i) {
    const bool fixture = packet.hit.instID[0][i] != RTC_INVALID_GEOMETRY_ID;
    const int triangle = fixture ? kFixture : static_cast<int>(packet.hit.primID[i]);
    lanes.triangle[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? kNothing : triangle;
    lanes.t_m[i] = packet.ray.tfar[i];
  }
}

template <int kWidth, class Packet>
void OccludedPacket(RTCScene scene, const RayBatch& rays, std::size_t begin, std::size_t n, Lanes& lanes) {
  Packet packet;
  Fill<kWidth>(rays, begin, n, lanes, packet);
  // Never coherent: Embree 3.13's coherent shadow packets can loop for ever on axis-parallel rays.
  Query(RayOrder::kScattered).Run(lanes.valid, scene, packet);
  for (int i = 0; i < kWidth; ++i) lanes.triangle[i] = packet.tfar[i] < 0.0f ? kFixture : kNothing;
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

EmbreeWorld::EmbreeWorld() : device_(rtcNewDevice("threads=1,set_affinity=0")) {
  if (!device_)
    throw std::runtime_error("Embree: no device (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
  fixtures_ = rtcNewScene(device_);
  rtcSetSceneFlags(fixtures_, RTC_SCENE_FLAG_DYNAMIC);
  if (!rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) packet_width_ = 8;
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
  rtcAttachGeometry(inner, triangles);
  rtcReleaseGeometry(triangles);
  rtcCommitScene(inner);
  RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, inner);
  rtcAttachGeometry(scene_, instance);
  rtcAttachGeometry(fixtures_, instance);
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
  rtcAttachGeometry(scene_, proxies_);
}

void EmbreeWorld::Commit() {
  rtcCommitScene(scene_);
  rtcCommitScene(fixtures_);
  const RTCError error = rtcGetDeviceError(device_);
  if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree: error " + std::to_string(error) + " in a scene");
}

void EmbreeWorld::Intersect(const RayBatch& rays, std::size_t begin, std::size_t n, RayOrder order,
                            Lanes& lanes) const {
  const auto trace = packet_width_ == 16 ? IntersectPacket<16, RTCRayHit16> : IntersectPacket<8, RTCRayHit8>;
  trace(scene_, rays, begin, n, order, lanes);
}

void EmbreeWorld::Occluded(const RayBatch& rays, std::size_t begin, std::size_t n, Lanes& lanes) const {
  const auto trace = packet_width_ == 16 ? OccludedPacket<16, RTCRay16> : OccludedPacket<8, RTCRay8>;
  trace(fixtures_, rays, begin, n, lanes);
}

}  // namespace twinbench::optics
