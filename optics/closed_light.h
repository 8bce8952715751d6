#pragma once

#include <optional>

#include "optics/bench_parameters.h"
#include "optics/kernels.h"
#include "optics/landing.h"
#include "optics/scene.h"

/// Laser, grating, detector as the formula of one way: windows do not bend it, fixtures cast shadows on it.
namespace twinbench::optics {

/// Immutable after construction; const members may run in several threads.
class ClosedLight {
 public:
  ClosedLight(const RotaryOpticsParameters& parameters, const std::array<Eigen::Isometry3d, 2>& X_LP);

  /// One ray in the plane of detector `i`, whatever stands in the way.
  /// @param grating  The frame of its surface in L.
  Landing Reach(const Frame& grating, const Ray& ray, double wavelength_m, int i) const {
    return Follow(grating, ray, wavelength_m, i).landing;
  }

  /// The same with the shadows of fixtures.
  Landing Trace(const Frame& grating, const Eigen::Isometry3d& X_LG, const Ray& ray, double wavelength_m,
                int i) const;

  /// Whether a fixture stands between two points.
  bool Blocked(const Eigen::Isometry3d& X_LG, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;

 private:
  struct Way {
    Landing landing;
    Eigen::Vector3d on_grating_m = Eigen::Vector3d::Zero();
    double onwards_m = 0.0;
  };
  Way Follow(const Frame& grating, const Ray& ray, double wavelength_m, int i) const;

  LocalGrating GratingAt(const Frame& grating, double x_m, double y_m) const;

  double lines_per_m_;
  std::optional<GratingForm> form_;
  std::array<Frame, 2> planes_;
  std::optional<Scene> fixed_blockers_;
  std::optional<Scene> riding_blockers_;
};

}  // namespace twinbench::optics
