#pragma once

#include <span>

#include "optics/bench_parameters.h"
#include "optics/landing.h"
#include "optics/power_map.h"

/// A measured beam on a detector, pixel by pixel.
namespace twinbench::optics {

/// One order of a beam on one detector.
struct BeamOnDetector {
  const PsdParameters& psd;
  Eigen::Isometry3d X_LP;
  Eigen::Vector3d incident;  // of the chief ray, at the grating
  Eigen::Vector3d grating_normal;
  Eigen::Vector3d order;  // of the chief ray, behind the grating
  Eigen::Vector2d pixel_m;
  double wavelength_m;
};

/// Half sides along u and v of the rectangle with the second moments that a pixel of the beam has on the detector:
/// the parallel projection of the beam along its direction on to the grating, and along the order on to the plane.
Eigen::Vector2d HalfPixelOn(const BeamOnDetector& beam);

/// The rays of the beam as rectangles of light, each with its power behind the window. Where the window's faces
/// interfere, each rectangle has the transmission and the shift of its own place and direction.
///
/// @param nodes, landings  As many; rays that do not arrive are lost.
/// @param power_W          Of the whole beam in this order.
PowerMap MapOf(const BeamOnDetector& beam, const BeamNodes& nodes, std::span<const Landing> landings,
               double power_W);

}  // namespace twinbench::optics
