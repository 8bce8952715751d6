#pragma once

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"
#include "twin/core/frames.h"

/// The exact chain of the two stacked tables as homogeneous transforms, for the second-order terms of the
/// separation.
///
///   X_LG = X(-spot from target) X_err(target) Rz(phi) X(height) X_err(seat) Rz(beta) X_err(reference, base frame)
///          Rz(psi) Rz(-clamp) X(grating point) X_err(mount)
namespace twinbench::separate {

using measure::Vector4;
using Vector6 = Eigen::Matrix<double, 6, 1>;  // pose error [ex, ey, ez (rad), dx, dy, dz (m)]

/// The angles of one stop. beta: the reference's body on the target's rotor; clamp: the grating on the reference's
/// rotor. Lab azimuth of the reference's rotor: rho = target + reference + beta.
struct Stop {
  double target_rad = kNaN;
  double reference_rad = kNaN;
  double beta_rad = kNaN;
  double clamp_rad = kNaN;
};

/// What is out of place. The reference's error is given in its rotor frame, seat in the target's rotor frame at the
/// reference's origin, mount in L at the laser spot (at zero of everything else).
struct PoseErrors {
  Vector6 target = Vector6::Zero();
  Vector6 reference = Vector6::Zero();
  Vector6 seat = Vector6::Zero();
  Vector6 mount = Vector6::Zero();
};

/// Translate(dx, dy, dz) Rz(ez) Ry(ey) Rx(ex).
Pose ErrorPose(const Vector6& e);

/// Pose of the grating frame G in L.
Pose GratingPose(const Stop& stop, const PoseErrors& errors, const measure::BenchGeometry& geometry);

/// The motion [ez, ex, ey, dy] that a perfect measurement reads off this pose: its angles, and where the laser beam
/// (the y axis of L) meets the grating plane.
Vector4 MotionOf(const Pose& X_LG);

}  // namespace twinbench::separate
