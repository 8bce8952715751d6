#pragma once

#include <Eigen/Geometry>

namespace twinbench {

/// Frames of the rotary bench, named by one capital. `X_LG` is the pose of G seen in L and `p_LP`
/// the point P seen in L; neighbouring letters cancel: X_LG = X_LT * X_TR * X_RG.
///
///   L  laboratory: x dispersion direction, y grating normal towards laser and PSDs, z up;
///      origin at the nominal laser spot on the grating
///   T  rotor of the target table          S  body (base) of the reference table, standing on T
///   R  rotor of the reference table       G  grating: x across the grooves, y normal, z along them
///   A  PSD on order +1                    B  PSD on order -1 (x = u axis, y = v axis, z to the light)
using Pose = Eigen::Isometry3d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

}  // namespace twinbench
