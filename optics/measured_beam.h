#pragma once

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

/// Gathers the rays of the beam as rectangles of light, each with its power behind the window. Where the window's
/// faces interfere, each rectangle has the transmission and the shift of its own place and direction.
class MapMaker {
 public:
  /// @param rays     Expected. @param power_W  Of the whole beam in this order.
  MapMaker(const BeamOnDetector& beam, std::size_t rays, double power_W);

  /// A ray that arrives, with its share of the beam.
  void Add(double weight, const Landing& landing);

  /// What has not been added is lost.
  PowerMap Take();

 private:
  BeamOnDetector beam_;
  double power_W_;
  bool interferes_;
  double arrived_ = 0.0;
  PowerMap map_;
};

}  // namespace twinbench::optics
