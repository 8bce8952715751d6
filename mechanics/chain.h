#pragma once

#include <Eigen/Core>

#include "mechanics/pose_error.h"

/// The only geometry of the stacked rotary tables: from all angles and errors to the pose of the grating.
namespace twinbench::mechanics {

/// What a mounting fixes. Frames: L laboratory, T target rotor, S body of the reference table, R its rotor, G
/// grating.
struct ChainGeometry {
  Vector3 p_RG_m{0.0, 0.030, 0.050};                         // spot on the grating from the reference's origin
  double reference_height_m = 0.080;                         // reference's origin above the target's
  Eigen::Vector2d centring_m = Eigen::Vector2d::Zero();      // of S on T
  Eigen::Vector2d mount_tilt_rad = Eigen::Vector2d::Zero();  // of S on T: Ry(y) Rx(x)
  double reseat_rad = 0.0;                                   // of S on T about its axis, after the tilt
  double clamp_rad = 0.0;                                    // the grating is turned back by this on R
  bool operator==(const ChainGeometry&) const = default;
};

/// X_TS: pose of the reference's body on the target's rotor.
Pose BodyOnTarget(const ChainGeometry& geometry);

/// Deflection of one bearing under load, in the frame of its stator: Translate(x, y, z) Rx(rx) Ry(ry). Rotation
/// about the axis is the drive's and not here.
struct BearingPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double rx_rad = 0.0;
  double ry_rad = 0.0;
};

/// Component by component: right for deflections as small as bearings' are (first order).
BearingPose operator+(const BearingPose& a, const BearingPose& b);

/// Exact pose of a deflection.
Pose ToPose(const BearingPose& bearing);

/// What changes from reading to reading.
struct ChainState {
  double target_rad = 0.0;  // nominal angle of the rotor on its base; ez comes with the error
  double reference_rad = 0.0;
  PoseError target_error = {};     // laboratory frame
  PoseError reference_error = {};  // frame of its rotor
  BearingPose target_bearing = {};
  BearingPose reference_bearing = {};
  double goniometer_yaw_rad = 0.0;   // of the grating about the laser spot: Rz(yaw) Rx(tilt) in L,
  double goniometer_tilt_rad = 0.0;  // tilt positive turns the grating's normal upwards
};

/// X_LG of the stack, with everything that does not change between mountings multiplied in advance:
///
///   X_LG = Rz(yaw) Rx(tilt) * T(-height z - p_RG) * C_target E(target) Rz(target)
///          * T(centring, height) Ry Rx Rz(reseat) * C_reference E(reference) Rz(reference) * Rz(-clamp) T(p_RG)
class Chain {
 public:
  explicit Chain(const ChainGeometry& geometry);

  Pose GratingPose(const ChainState& state) const;         // X_LG
  Pose TargetRotorPose(const ChainState& state) const;     // X_LT, without goniometer
  Pose ReferenceRotorPose(const ChainState& state) const;  // X_LR, without goniometer

  const ChainGeometry& geometry() const { return geometry_; }

 private:
  ChainGeometry geometry_;
  Vector3 p_LT0_m_;  // origin of the target table
  Pose X_TS_;
  Pose X_RG_;
};

}  // namespace twinbench::mechanics
