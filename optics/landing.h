#pragma once

#include <Eigen/Core>

namespace twinbench::optics {

/// The end of one ray in the plane of a detector's silicon; it may lie beside the silicon.
struct Landing {
  bool arrives = false;
  double u_m = 0.0, v_m = 0.0;
  double transmission = 1.0;                            // of the window's faces
  Eigen::Vector2d in_air_m = Eigen::Vector2d::Zero();   // u, v of the same ray without the window
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // in L, in front of the window
};

}  // namespace twinbench::optics
