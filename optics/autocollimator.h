#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "optics/fidelity.h"
#include "optics/scene.h"

/// A dual-axis electronic autocollimator and the mirror it looks at, ray by ray.
///
/// Frame A: origin at the centre of the objective, z_A the optical axis towards the mirror, y_A up, hence x_A to
/// the left of somebody who looks from the instrument to the mirror. Frame M: the mirror's body.
namespace twinbench::optics {

struct AutocollimatorParameters {
  Fidelity fidelity = Fidelity::kTraced;  // the same numbers; closed, Embree is asked about fixtures only
  Eigen::Isometry3d X_LA = Eigen::Isometry3d::Identity();
  double focal_length_m = 0.3;          // of the objective
  double nominal_focal_length_m = 0.3;  // what readings are divided by; a difference is an error of scale
  double aperture_radius_m = 15e-3;     // of the objective; the outgoing beam fills it
  double defocus_m = 0.0;               // reticle and camera lie this far behind the objective's focal plane
  double distortion_per_rad2 = 0.0;     // the image is enlarged by 1 + distortion (field angle)^2
  double roll_rad = 0.0;                // of the camera, counter-clockwise as seen from behind it
  double pixel_pitch_m = 5e-6;
  double interpolation_error_px = 0.0;  // amplitude; none on the optical axis, which is a pixel's centre
  double half_field_rad = std::numeric_limits<double>::quiet_NaN();      // readings on either axis end there
  double low_light_fraction = std::numeric_limits<double>::quiet_NaN();  // less light than this gives no reading
  int pupil_rings = 7;                                                   // 4 rings^2 rays
};

enum class AutocollimatorStatus { kOk, kOutOfRange, kNoLight };

struct AutocollimatorImage {
  AutocollimatorStatus status = AutocollimatorStatus::kNoLight;
  double x_rad = std::numeric_limits<double>::quiet_NaN();  // NaN unless kOk
  double y_rad = std::numeric_limits<double>::quiet_NaN();
  double returned_fraction = 0.0;  // of the light that left the objective
};

/// A point reticle in the focal plane, its parallel beam to the mirror and back through the same objective (an
/// ideal thin lens), and the centroid of the image on the camera.
///
/// The mirror reflects on its +z side; positive curvature is concave there. A flatness error of sag h over a width
/// H is a paraboloid of curvature 8 h / H^2.
class AutocollimatorOptics {
 public:
  /// @param mirror  Its pose is taken as X_MS, the surface in the frame of the mirror's body.
  /// @throws std::invalid_argument naming what is missing or out of range.
  AutocollimatorOptics(const AutocollimatorParameters& parameters, const Surface& mirror);

  /// What the camera shows of the mirror at X_LM, which should be within 1 m (see Scene).
  ///
  /// Status kOutOfRange beyond half_field_rad, kNoLight if too little light comes back. Readings: x of a normal
  /// turned counter-clockwise as seen from above (about y_A), y of one turned upwards, each half of the
  /// deflection's tangent (at 300 arcsec that exceeds the angle itself by 0.0008 arcsec). A roll g, right-handed
  /// about -z_A, gives x' = x cos g + y sin g and y' = y cos g - x sin g, hence x' = (x + y' sin g) / cos g.
  ///
  /// @throws std::invalid_argument if X_LM is not a pose.
  ///
  /// Not included: diffraction, the size of the reticle's image (it is off the camera as a whole or not at all),
  /// light that goes to and fro more than once. Edges of the mirror cut in steps of single rays.
  /// Not for several threads at once: the mirror moves in a scene of its own.
  /// Reference: Guo et al. (2014) eq. 1 and Delta_1 = 8 h dL rho / H^2 (flatness and beam walk).
  AutocollimatorImage Look(const Eigen::Isometry3d& X_LM);

 private:
  void Intersect(const RayBatch& rays);
  AutocollimatorImage ReadCamera() const;

  AutocollimatorParameters parameters_;
  Eigen::Isometry3d X_MS_;
  Scene scene_;  // in frame A
  RayBatch outgoing_;
  RayBatch returning_;
  HitBatch hits_;
};

}  // namespace twinbench::optics
