#pragma once

#include "optics/element_scene.h"

/// A camera beside a beam that tells from where the beam's spot appears how far away a surface is.
namespace twinbench::optics {

/// Frame T: the beam runs along -z; its origin is seen in the middle. The lens stands in the x-z plane on the +x
/// side.
struct TriangulationParameters {
  double object_m = 0.0;   // from T's origin to the lens
  double image_m = 0.0;    // from the lens to the sensor
  double alpha_rad = 0.0;  // between the beam and the lens' axis
  double lens_radius_m = 5e-3;
};

/// The sensor is inclined so that the whole beam is sharp (Scheimpflug): object tan(alpha) = image tan(beta), beta
/// between sensor and axis.
class Triangulation {
 public:
  /// @throws std::invalid_argument naming what is not positive, or an angle that is not between 0 and 90 deg.
  explicit Triangulation(const TriangulationParameters& parameters);

  /// Place on the sensor's line [m] at which a spot appears, by the ray through `pupil_m` of the lens (its centre:
  /// the chief ray); positive for a spot beyond T's origin. NaN if no light of it gets there.
  double Seen_m(const Eigen::Vector3d& spot_m, const Eigen::Vector2d& pupil_m = Eigen::Vector2d::Zero()) const;

  const Scene& scene() const { return elements_.scene(); }

 private:
  Eigen::Isometry3d X_TL_;  // the lens, its z towards the beam
  ElementScene elements_;
  std::vector<WayStep> way_;
};

}  // namespace twinbench::optics
