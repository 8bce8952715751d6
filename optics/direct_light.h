#pragma once

#include <span>
#include <vector>

#include "optics/kernels.h"
#include "optics/landing.h"
#include "optics/rotary_scenes.h"

/// Laser, grating, detector: the way of the light that is measured, ray by ray.
namespace twinbench::optics {

/// Grating poses, one for all rays or one for each.
struct GratingPoses {
  explicit GratingPoses(std::span<const Eigen::Isometry3d> poses);

  std::span<const Eigen::Isometry3d> X_LG;
  std::vector<Eigen::Isometry3d> X_GL;

  std::size_t Of(std::size_t ray) const { return X_LG.size() == 1 ? 0 : ray; }
};

/// Embree finds every surface on the way; where a ray meets it, how it is diffracted and refracted is computed in
/// double. Light that meets nothing behind the grating passes beside the detector and lands where its plane is met.
///
/// Immutable after construction; const members may run in several threads.
class DirectLight {
 public:
  DirectLight(const RotaryOpticsParameters& parameters, const std::array<Eigen::Isometry3d, 2>& X_LP);

  /// One ray on both detectors.
  std::array<Landing, 2> Trace(const Eigen::Isometry3d& X_LG, const Ray& ray, double wavelength_m) const;

  /// Many rays on both detectors, in packets.
  ///
  /// @param wavelength_m  As many as poses.
  /// @return for each detector one landing for each ray.
  std::array<std::vector<Landing>, 2> Trace(const GratingPoses& poses, const RayBatch& rays,
                                            std::span<const double> wavelength_m) const;

  const RotaryScenes& scenes() const { return scenes_; }

 private:
  struct Way;  // of one ray behind the grating

  bool Leave(const Eigen::Isometry3d& X_LG, const Ray& ray, const RotaryHit& hit, double wavelength_m, int i,
             Way& way) const;
  bool Advance(const RotaryHit& hit, int i, Way& way) const;
  bool Refract(const RotaryHit& hit, int i, Way& way) const;
  static void Land(double u_m, double v_m, Way& way);
  void FollowAll(const GratingPoses& poses, std::vector<Way>& ways, int i, std::vector<Landing>& landings) const;

  RotaryScenes scenes_;
  double lines_per_m_;
  std::array<std::optional<Window>, 2> window_;
  std::array<Frame, 2> plane_;  // of the silicon
};

}  // namespace twinbench::optics
