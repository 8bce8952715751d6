#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <span>

#include "optics/power_map.h"
#include "optics/window.h"

/// A position-sensitive detector: where the centroid of the light on a finite area is, and how much light.
namespace twinbench::optics {

enum class PsdStatus {
  kOk,
  kClipped,  // part of the spot (more than kClippedShare) is lost at an edge or on the way: the centroid is pulled
  kMissed,   // light is there, but not on the active area
  kNoLight,  // nothing arrives in this detector's plane
};

/// Share of the spot beyond which a loss is reported: about 4.3 sigma, where the pull is 1e-4 sigma.
inline constexpr double kClippedShare = 1e-5;

/// Frame P: x = u, y = v in the active area, z towards the light; origin at the centre.
struct PsdParameters {
  double distance_m = std::numeric_limits<double>::quiet_NaN();  // nominal spot on the grating -> centre
  double roll_rad = 0.0;                                         // about z_P
  double tilt_u_rad = 0.0;                                       // then about the u axis
  double tilt_v_rad = 0.0;                                       // then about the v axis
  double width_m = std::numeric_limits<double>::quiet_NaN();     // along u
  double height_m = std::numeric_limits<double>::quiet_NaN();    // along v
  double cubic_per_m2 = 0.0;                                     // u -> u (1 + cubic r^2), v likewise
  double stray_fraction = 0.0;                                   // uniform stray light / signal
  double silicon_reflectance = 0.0;
  std::optional<Window> window;
};

/// Pose of a detector that looks along the nominal order at `order_angle_rad` from the grating's normal y_L.
///
/// Positive angles lie on the +x side; u points away from the normal on the +x side and towards it on the other, so
/// that +u has a positive x component on both.
Eigen::Isometry3d PsdPose(const PsdParameters& psd, double order_angle_rad);

/// Second moments of a patch of light in the detector's plane.
struct Spot {
  double u_m = 0.0;
  double v_m = 0.0;
  double power_W = 0.0;
  Eigen::Matrix2d cov_m2 = Eigen::Matrix2d::Zero();  // zero: a point
  double lost_share = 0.0;                           // cut off on the way, not in power_W any more
};

struct PsdSignal {
  double u_m = std::numeric_limits<double>::quiet_NaN();
  double v_m = std::numeric_limits<double>::quiet_NaN();
  double power_W = 0.0;  // collected, stray light included
  PsdStatus status = PsdStatus::kNoLight;
};

/// What of a Gaussian spot falls on the active area: its power, centroid and covariance diagonal.
///
/// Exact for a spot whose axes are parallel to the edges, and for any spot that meets one pair of edges only; for
/// an inclined ellipse over a corner the two cuts are treated as independent.
Spot Truncate(const Spot& spot, double width_m, double height_m);

/// The detector's answer to several patches; the first is the signal proper, whose loss makes kClipped.
///
/// Each patch is cut at the edges, displaced by the cubic non-linearity and weighted with its power; uniform stray
/// light f adds power f and pulls the centroid to the centre by 1 / (1 + f).
PsdSignal Respond(const PsdParameters& psd, std::span<const Spot> spots);

/// The same for a measured beam as it falls, rectangle by rectangle: each is cut at the edges and displaced by the
/// non-linearity for itself. `others` is light that came on other ways.
PsdSignal Respond(const PsdParameters& psd, const PowerMap& signal, std::span<const Spot> others);

/// The same for one point-like patch: the hot path.
PsdSignal RespondToPoint(const PsdParameters& psd, double u_m, double v_m, double power_W);

/// @throws std::invalid_argument naming the field that is missing or out of range.
void Validate(const PsdParameters& psd);

}  // namespace twinbench::optics
