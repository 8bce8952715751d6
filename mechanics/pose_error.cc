#include "mechanics/pose_error.h"

#include <cmath>

namespace twinbench::mechanics {

PoseError operator+(const PoseError& a, const PoseError& b) {
  return {a.ex_rad + b.ex_rad, a.ey_rad + b.ey_rad, a.ez_rad + b.ez_rad,
          a.dx_m + b.dx_m,     a.dy_m + b.dy_m,     a.dz_m + b.dz_m};
}

Matrix3 RotationX(double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return (Matrix3() << 1, 0, 0, 0, c, -s, 0, s, c).finished();
}

Matrix3 RotationY(double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return (Matrix3() << c, 0, s, 0, 1, 0, -s, 0, c).finished();
}

Matrix3 RotationZ(double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return (Matrix3() << c, -s, 0, s, c, 0, 0, 0, 1).finished();
}

Pose ToPose(const PoseError& error) {
  Pose pose = Pose::Identity();
  pose.linear() = RotationZ(error.ez_rad) * RotationY(error.ey_rad) * RotationX(error.ex_rad);
  pose.translation() = Vector3(error.dx_m, error.dy_m, error.dz_m);
  return pose;
}

PoseError RotorToBase(const PoseError& rotor, double rotor_angle_rad) {
  const double c = std::cos(rotor_angle_rad);
  const double s = std::sin(rotor_angle_rad);
  PoseError base = rotor;
  base.ex_rad = c * rotor.ex_rad - s * rotor.ey_rad;
  base.ey_rad = s * rotor.ex_rad + c * rotor.ey_rad;
  base.dx_m = c * rotor.dx_m - s * rotor.dy_m;
  base.dy_m = s * rotor.dx_m + c * rotor.dy_m;
  return base;
}

}  // namespace twinbench::mechanics
