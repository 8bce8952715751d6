#pragma once

#include <Eigen/Core>
#include <vector>

#include "optics/irradiance.h"

/// Light on a detector as it falls there: many small rectangles, each with its power.
namespace twinbench::optics {

struct PowerPatch {
  double u_m = 0.0, v_m = 0.0;  // centre
  double power_W = 0.0;
};

/// What the rays of a measured beam bring to a detector's plane. A ray stands for a pixel of the beam; on the
/// detector that is a rectangle along u and v with the pixel's second moments there, alike for all.
struct PowerMap {
  std::vector<PowerPatch> patches;
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();  // of each rectangle's sides
  double lost_share = 0.0;                           // cut off on the way

  double power_W() const;
};

/// The part of a rectangle within +- the sides' halves of a detector, by area.
PowerPatch CutToArea(const PowerPatch& patch, const Eigen::Vector2d& half_m, double width_m, double height_m);

/// Adds the map's rectangles to a picture, by the area that they share with each pixel.
void Paint(const PowerMap& map, IrradianceMap& picture);

}  // namespace twinbench::optics
