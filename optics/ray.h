#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "optics/column.h"

/// Light as straight rays, in metres. Directions are unit vectors.
namespace twinbench::optics {

struct Ray {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

/// Many rays as separate arrays, all of one length, the way the vector units want them.
struct RayBatch {
  Column<double> ox{0}, oy{1}, oz{2};  // origin [m]
  Column<double> dx{3}, dy{4}, dz{5};  // unit direction

  std::size_t size() const { return ox.size(); }
  void Resize(std::size_t size);
  void Add(const Ray& ray);
  void Set(std::size_t i, const Ray& ray);
  Ray At(std::size_t i) const { return {{ox[i], oy[i], oz[i]}, {dx[i], dy[i], dz[i]}}; }
};

/// kCoherent for beams, whose neighbours travel together; kScattered for stray light in all directions.
enum class RayOrder { kCoherent, kScattered };

/// What is not an optical surface in HitBatch::surface.
inline constexpr int kNothing = -1;
inline constexpr int kFixture = -2;  // a mesh: absorbed

/// The first thing each ray meets.
struct HitBatch {
  Column<int> surface{9};  // index of the surface, kNothing or kFixture
  Column<double> t_m{6};   // path length; infinite for kNothing
  Column<double> x_m{7};   // in the surface's frame; undefined unless a surface was hit
  Column<double> y_m{8};

  void Resize(std::size_t size);
  /// `n` rays from `begin` on meet nothing.
  void Clear(std::size_t begin, std::size_t n);
  void Reset(std::size_t size);
};

}  // namespace twinbench::optics
