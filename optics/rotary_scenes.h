#pragma once

#include <span>

#include "optics/bench_parameters.h"
#include "optics/scene.h"

/// All that light can meet on the rotary bench, for Embree to find.
namespace twinbench::optics {

/// kDark: nothing is met; kObstacle: a fixture, which absorbs.
enum class RotaryElement { kDark, kObstacle, kGrating, kSilicon, kWindowFace };

/// What a ray meets first.
struct RotaryHit {
  RotaryElement element = RotaryElement::kDark;
  int detector = -1;  // of silicon and window faces
  int surface = -1;   // in the scene of the laboratory; of silicon and window faces
  SurfaceHit hit;     // x, y in the surface's frame
};

/// Whether light may meet what rides on the grating. A plane is not met again by light that leaves it.
enum class Meets { kEverything, kLaboratory };

/// Two scenes that stand still: one in G with the grating and what rides on it; one in L with both detectors'
/// packages (silicon and rim, window faces) and the laboratory's fixtures. Only rays are turned from one to the
/// other, so nothing is committed again for a new pose.
///
/// Immutable after construction; const members may run in several threads.
class RotaryScenes {
 public:
  RotaryScenes(const RotaryOpticsParameters& parameters, const std::array<Eigen::Isometry3d, 2>& X_LP);

  /// The first meeting of a ray given in L, for a grating at X_GL^-1.
  RotaryHit First(const Eigen::Isometry3d& X_GL, const Ray& ray, Meets meets = Meets::kEverything) const;

  /// What many rays meet, and room for finding it.
  struct Hits {
    std::vector<RotaryHit> first;  // one for each ray
    HitBatch met;
    RayBatch turned;
  };

  /// The same for many, in packets. @param X_GL  One for all rays, or one for each.
  void First(std::span<const Eigen::Isometry3d> X_GL, const RayBatch& rays, Meets meets, Hits& hits) const;

  /// What light that has left the grating's front can still meet.
  Meets behind_grating() const { return rides_ ? Meets::kEverything : Meets::kLaboratory; }

  /// A surface of the laboratory, by RotaryHit::surface.
  const Surface& surface(int index) const { return laboratory_.surfaces()[static_cast<std::size_t>(index)]; }

  std::uint64_t rays_traced() const { return riding_.rays_traced() + laboratory_.rays_traced(); }

 private:
  RotaryHit OnGrating(const NearestHit& met) const;
  RotaryHit InLaboratory(const NearestHit& met) const;
  void AddDetector(const PsdParameters& psd, const Eigen::Isometry3d& X_LP, int i);

  struct Part {
    RotaryElement element;
    int detector;
  };
  Scene riding_;
  Scene laboratory_;
  std::vector<Part> parts_;  // of the laboratory's surfaces
  bool rides_ = false;       // something beside the grating does
};

}  // namespace twinbench::optics
