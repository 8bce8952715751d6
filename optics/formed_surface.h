#pragma once

#include <vector>

#include "optics/height_map.h"
#include "optics/scene.h"

/// A reflecting surface as it is made: a conic and, beside its form, heights from a map.
namespace twinbench::optics {

/// Where rays meet a surface, and which way it stands there.
struct SurfacePoints {
  std::vector<char> is_met;
  std::vector<Eigen::Vector3d> point_m, normal;  // undefined where nothing is met

  void Resize(std::size_t size);
};

/// Static: one surface in a scene of its own. Const members may run in several threads.
class FormedSurface {
 public:
  /// @param surface  Rays are given in its frame: its pose does not count. It reflects on +z.
  /// @throws std::invalid_argument from Validate(surface).
  explicit FormedSurface(Surface surface);

  /// Embree finds the conic, double arithmetic the point on it; with heights, Newton's steps go on to the surface
  /// that carries them, and its normal has their slope.
  ///
  /// @param form  Null: the surface has its form. Heights along z, which must be small against its radius.
  /// @param vertex_m  Of the surface, in the map.
  void Meet(const RayBatch& rays, const HeightMap* form, const Eigen::Vector2d& vertex_m,
            SurfacePoints& points) const;

  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
};

}  // namespace twinbench::optics
