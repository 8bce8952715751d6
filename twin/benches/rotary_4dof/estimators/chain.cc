#include "twin/benches/rotary_4dof/estimators/chain.h"

#include <cmath>

namespace twinbench::separate {
namespace {

Pose Shift(const Vector3& p) {
  return Pose(Eigen::Translation3d(p));
}

Pose TurnZ(double angle_rad) {
  return Pose(Eigen::AngleAxisd(angle_rad, Vector3::UnitZ()));
}

/// Both vector pairs turned about z; ez and dz lie along the axis.
Vector6 TurnedPairs(const Vector6& e, double angle_rad) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  Vector6 turned = e;
  turned.head<2>() = turn * e.head<2>();
  turned.segment<2>(3) = turn * e.segment<2>(3);
  return turned;
}

}  // namespace

Pose ErrorPose(const Vector6& e) {
  return Eigen::Translation3d(e[3], e[4], e[5]) * Eigen::AngleAxisd(e[2], Vector3::UnitZ()) *
         Eigen::AngleAxisd(e[1], Vector3::UnitY()) * Eigen::AngleAxisd(e[0], Vector3::UnitX());
}

Pose GratingPose(const Stop& stop, const PoseErrors& errors, const measure::BenchGeometry& geometry) {
  const Vector3 height(0.0, 0.0, geometry.reference_height_m);
  const Pose target = Shift(-geometry.SpotFromTarget()) * ErrorPose(errors.target) * TurnZ(stop.target_rad);
  const Pose body = Shift(height) * ErrorPose(errors.seat) * TurnZ(stop.beta_rad);
  const Pose rotor =
      ErrorPose(TurnedPairs(errors.reference, stop.reference_rad)) * TurnZ(stop.reference_rad - stop.clamp_rad);
  return target * body * rotor * Shift(geometry.grating_point_m) * ErrorPose(errors.mount);
}

Vector4 MotionOf(const Pose& X_LG) {
  const Matrix3 R = X_LG.linear();
  const Vector3 normal = R.col(1);
  return {std::atan2(R(1, 0), R(0, 0)), std::atan2(R(2, 1), R(2, 2)),
          std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), normal.dot(X_LG.translation()) / normal.y()};
}

}  // namespace twinbench::separate
