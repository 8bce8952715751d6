#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "optics/mesh.h"
#include "optics/surface.h"

struct RTCSceneTy;  // Embree's scene; its headers stay out of ours

/// Non-sequential tracing: which of many surfaces and housings does each ray meet first?
namespace twinbench::optics {

/// Analytic surfaces and meshes with poses.
///
/// Embree computes in float, so it only chooses: it traces padded proxies in packets, and every hit is recomputed
/// in double on the analytic surface, with the aperture decided in double; where double says "outside" the ray goes
/// on behind the proxy. Holds for coordinates below about 1 m from the origin and for incidence up to 89 deg.
///
/// Changing a pose is cheap (each mesh lives in a scene of its own). Const members may run in several threads.
class Scene {
 public:
  /// @param embree_options  For tests: how Embree sets itself up, for instance "max_isa=avx2".
  explicit Scene(const std::string& embree_options = "");
  /// Empty, on the Embree device of another one: a device of its own costs 0.1 ms.
  static Scene OnDeviceOf(const Scene& other);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// @return Index of the surface. @throws std::invalid_argument from Validate(surface).
  int AddSurface(const Surface& surface);
  /// @return Index of the mesh. @throws std::invalid_argument if a triangle names a vertex that is not there.
  int AddMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& X_WM);

  void SetSurfacePose(int index, const Eigen::Isometry3d& X_WS);
  void SetMeshPose(int index, const Eigen::Isometry3d& X_WM);

  /// Makes additions and new poses visible to Intersect, IntersectWithoutEmbree and Occluded.
  void Commit();

  const std::vector<Surface>& surfaces() const;

  /// First meeting of every ray beyond `t_min_m`. Meshes give kFixture, their t_m only to float accuracy.
  /// @throws std::logic_error before Commit.
  void Intersect(const RayBatch& rays, HitBatch& hits, RayOrder order = RayOrder::kCoherent) const;

  /// The same for one ray: without a packet, a third of its cost.
  NearestHit First(const Ray& ray) const;

  /// The same answer from double arithmetic alone: every surface and every triangle. Faster than Embree for up to
  /// about ten surfaces without meshes; otherwise the yardstick that Intersect is tested with.
  void IntersectAnalytic(const RayBatch& rays, HitBatch& hits) const;

  /// Does a mesh stand between two points?
  bool Occluded(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;

  /// How many rays Embree has been asked about by Intersect and First so far: what shows that light was traced.
  std::uint64_t rays_traced() const;

  /// Rays per packet on this machine: 16 where Embree has them natively, else 8.
  int packet_width() const;

  /// The bare Embree scene, for measuring what the double arithmetic costs.
  RTCSceneTy* embree_scene() const;

  /// A meeting closer than this to the ray's origin is the surface the ray starts on.
  static constexpr double t_min_m = 1e-6;

 private:
  struct Impl;
  explicit Scene(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace twinbench::optics
