#pragma once

#include <functional>
#include <string>
#include <vector>

#include "optics/kernels.h"
#include "optics/mesh.h"
#include "optics/ray.h"

struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCGeometryTy;

/// Embree 3 or 4 behind plain types: triangles in float, packets of rays.
namespace twinbench::optics {

/// Packets that Embree traces together: so many stay in the first-level cache with what it notes of them.
inline constexpr std::size_t kTogether = 4;

/// Rays whose answers are handed on together.
inline constexpr std::size_t kTileRays = 128;

/// One packet's bounds, a lane for each ray.
struct alignas(64) Bounds {
  int valid[kMaxPacket];  // -1 traced, 0 not
  float near_m[kMaxPacket];
  float far_m[kMaxPacket];
};

/// What Embree says of one ray.
struct Answer {
  int triangle = kNothing;  // of the proxies; kNothing or kFixture
  float t_m = std::numeric_limits<float>::infinity();
};

class EmbreeWorld {
 public:
  /// @param options  Embree's own, for instance "max_isa=avx2".
  explicit EmbreeWorld(const std::string& options);
  /// A world of its own on another's device.
  explicit EmbreeWorld(RTCDeviceTy* device);
  ~EmbreeWorld();
  EmbreeWorld(const EmbreeWorld&) = delete;
  EmbreeWorld& operator=(const EmbreeWorld&) = delete;

  /// Each mesh in a scene of its own, so that a new pose does not rebuild its tree.
  void AddMesh(const TriangleMesh& mesh);
  void SetMeshPose(int index, const Eigen::Isometry3d& X_WM);

  /// All proxies as one geometry. With `same_topology` the triangles are as before and only the vertices moved.
  void SetProxies(const TriangleMesh& proxies, bool same_topology);

  void Commit();

  int packet_width() const { return packet_width_; }
  RTCDeviceTy* device() const { return device_; }
  RTCSceneTy* scene() const { return scene_; }

  /// What is done with the answers of one tile: `packets` whole packets, at most kTileRays rays, from ray `begin` on.
  using Tile = std::function<void(std::size_t begin, std::size_t packets, RawAnswers answers)>;

  /// Nearest triangle beyond `near_m` for the first `packets` whole packets of packet_width() rays, tile by tile.
  void Intersect(const RayBatch& rays, std::size_t packets, float near_m, RayOrder order, const Tile& tile) const;

  /// Nearest triangle for one ray between two distances, without a packet around it.
  Answer Intersect(const Ray& ray, float near_m, float far_m) const;

  /// Nearest triangle for one packet of `n` <= packet_width() rays, where its bounds allow.
  void Intersect(const RayBatch& rays, std::size_t begin, std::size_t n, RayOrder order, const Bounds& bounds,
                 Answers answers) const;

  /// Whether a mesh is in the way (proxies do not count): triangle becomes kFixture or kNothing.
  void Occluded(const RayBatch& rays, std::size_t begin, std::size_t n, const Bounds& bounds,
                Answers answers) const;

 private:
  struct Instance {
    RTCSceneTy* scene;
    RTCGeometryTy* geometry;
  };
  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;     // proxies and meshes
  RTCSceneTy* fixtures_ = nullptr;  // meshes alone, for shadow rays
  RTCGeometryTy* proxies_ = nullptr;
  std::vector<Instance> instances_;
  int packet_width_ = kMaxPacket;
  bool has_streams_ = false;  // a call of Embree's for many packets of this width
};

}  // namespace twinbench::optics
