#include "mechanics/chain.h"

#include <cmath>

namespace twinbench::mechanics {
namespace {

/// Turns `pose` about its own z axis, which leaves its third column and origin alone.
void TurnAboutOwnZ(Pose& pose, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  const Vector3 x = pose.linear().col(0);
  const Vector3 y = pose.linear().col(1);
  pose.linear().col(0) = c * x + s * y;
  pose.linear().col(1) = c * y - s * x;
}

bool IsZero(const BearingPose& b) {
  return b.x_m == 0.0 && b.y_m == 0.0 && b.z_m == 0.0 && b.rx_rad == 0.0 && b.ry_rad == 0.0;
}

/// Follows one table: bearing deflection, error, rotation.
void FollowTable(Pose& pose, const BearingPose& bearing, const PoseError& error, double angle_rad) {
  if (!IsZero(bearing)) pose = pose * ToPose(bearing);
  pose = pose * ToPose(error);
  TurnAboutOwnZ(pose, angle_rad);
}

Pose GratingOnRotor(const ChainGeometry& g) {
  Pose pose = Pose::Identity();
  pose.linear() = RotationZ(-g.clamp_rad);
  pose.translation() = pose.linear() * g.p_RG_m;
  return pose;
}

}  // namespace

Pose BodyOnTarget(const ChainGeometry& g) {
  Pose pose = Pose::Identity();
  pose.linear() = RotationY(g.mount_tilt_rad.y()) * RotationX(g.mount_tilt_rad.x()) * RotationZ(g.reseat_rad);
  pose.translation() = Vector3(g.centring_m.x(), g.centring_m.y(), g.reference_height_m);
  return pose;
}

BearingPose operator+(const BearingPose& a, const BearingPose& b) {
  return {a.x_m + b.x_m, a.y_m + b.y_m, a.z_m + b.z_m, a.rx_rad + b.rx_rad, a.ry_rad + b.ry_rad};
}

Pose ToPose(const BearingPose& bearing) {
  Pose pose = Pose::Identity();
  pose.linear() = RotationX(bearing.rx_rad) * RotationY(bearing.ry_rad);
  pose.translation() = Vector3(bearing.x_m, bearing.y_m, bearing.z_m);
  return pose;
}

Chain::Chain(const ChainGeometry& geometry)
    : geometry_(geometry),
      p_LT0_m_(-geometry.p_RG_m - Vector3(0.0, 0.0, geometry.reference_height_m)),
      X_TS_(BodyOnTarget(geometry)),
      X_RG_(GratingOnRotor(geometry)) {}

Pose Chain::TargetRotorPose(const ChainState& state) const {
  Pose X_LT = Pose::Identity();
  X_LT.translation() = p_LT0_m_;
  FollowTable(X_LT, state.target_bearing, state.target_error, state.target_rad);
  return X_LT;
}

Pose Chain::ReferenceRotorPose(const ChainState& state) const {
  Pose X_LR = TargetRotorPose(state) * X_TS_;
  FollowTable(X_LR, state.reference_bearing, RotorToBase(state.reference_error, state.reference_rad),
              state.reference_rad);
  return X_LR;
}

Pose Chain::GratingPose(const ChainState& state) const {
  const Pose X_LG = ReferenceRotorPose(state) * X_RG_;
  if (state.goniometer_yaw_rad == 0.0 && state.goniometer_tilt_rad == 0.0) return X_LG;
  return Pose(RotationZ(state.goniometer_yaw_rad) * RotationX(state.goniometer_tilt_rad)) * X_LG;
}

}  // namespace twinbench::mechanics
