#pragma once

#include <cstdint>
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
  /// One ray behind the grating.
  struct Way {
    Ray ray;
    std::uint32_t index = 0;  // of the ray of the beam
    bool behind_window = false;
    bool in_glass = false;
    Landing landing;
  };

 public:
  DirectLight(const RotaryOpticsParameters& parameters, const std::array<Eigen::Isometry3d, 2>& X_LP);

  /// One ray on both detectors.
  std::array<Landing, 2> Trace(const Eigen::Isometry3d& X_LG, const Ray& ray, double wavelength_m) const;

  /// Where many rays land on both detectors, and room for finding it.
  struct Landings {
    std::array<std::vector<Landing>, 2> on;  // for each detector one for each ray

   private:
    friend class DirectLight;
    RotaryScenes::Hits on_grating, hits;
    RayBatch rays;
    std::vector<Way> ways;
    std::vector<Eigen::Isometry3d> X_GL;
  };

  /// Many rays on both detectors, in packets.
  /// @param wavelength_m  As many as poses.
  void Trace(const GratingPoses& poses, const RayBatch& rays, std::span<const double> wavelength_m,
             Landings& landings) const;

  const RotaryScenes& scenes() const { return scenes_; }

 private:
  bool Leave(const Eigen::Isometry3d& X_LG, const Ray& ray, const RotaryHit& hit, double wavelength_m, int i,
             Way& way) const;
  bool Advance(const RotaryHit& hit, int i, Way& way) const;
  bool Refract(const RotaryHit& hit, int i, Way& way) const;
  static void Land(double u_m, double v_m, Way& way);
  void LeaveAll(const GratingPoses& poses, const RayBatch& rays, std::span<const double> wavelength_m, int i,
                Landings& landings) const;
  void FollowAll(const GratingPoses& poses, int i, Landings& landings) const;

  RotaryScenes scenes_;
  double lines_per_m_;
  std::optional<GratingForm> form_;
  std::array<std::optional<Window>, 2> window_;
  std::array<Frame, 2> plane_;  // of the silicon
};

}  // namespace twinbench::optics
