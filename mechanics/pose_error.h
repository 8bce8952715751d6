#pragma once

#include <Eigen/Geometry>
#include <array>

/// The six error motions of a rotary table as one value, and the pose they make.
namespace twinbench::mechanics {

using Pose = Eigen::Isometry3d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

inline constexpr int kErrorComponents = 6;

/// Error motions of one rotary table at one angle, about and along the axes of the frame it is given in:
/// ex, ey wobble, ez index, dx, dy radial, dz axial, always in this order. No error is all zero.
struct PoseError {
  double ex_rad = 0.0;
  double ey_rad = 0.0;
  double ez_rad = 0.0;
  double dx_m = 0.0;
  double dy_m = 0.0;
  double dz_m = 0.0;

  std::array<double, kErrorComponents> Array() const { return {ex_rad, ey_rad, ez_rad, dx_m, dy_m, dz_m}; }
  static PoseError FromArray(const std::array<double, kErrorComponents>& e) {
    return {e[0], e[1], e[2], e[3], e[4], e[5]};
  }
};

/// Component by component, [rad, m]: right for poses as small as errors are (first order).
PoseError operator+(const PoseError& a, const PoseError& b);

/// Rotation by `angle_rad` about x, y or z, right-handed.
Matrix3 RotationX(double angle_rad);
Matrix3 RotationY(double angle_rad);
Matrix3 RotationZ(double angle_rad);

/// Pose Translate(dx, dy, dz) Rz(ez) Ry(ey) Rx(ex), exact for every angle.
Pose ToPose(const PoseError& error);

/// Components of a rotor-fixed error seen in the frame of the table's base: the pairs (ex, ey) and (dx, dy) turn
/// with the rotor, ez and dz lie along the axis and stay.
PoseError RotorToBase(const PoseError& rotor, double rotor_angle_rad);

}  // namespace twinbench::mechanics
