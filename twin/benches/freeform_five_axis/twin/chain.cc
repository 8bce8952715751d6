#include "twin/benches/freeform_five_axis/twin/chain.h"

#include <cmath>

namespace twinbench::sim {
namespace {

enum Squareness { kSyx, kSzx, kSzy, kSay, kSaz, kSbx, kSbz };

Matrix3 Rx(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return Matrix3{{1.0, 0.0, 0.0}, {0.0, c, -s}, {0.0, s, c}};
}
Matrix3 Ry(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return Matrix3{{c, 0.0, s}, {0.0, 1.0, 0.0}, {-s, 0.0, c}};
}
Matrix3 Rz(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return Matrix3{{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}};
}

Pose Moved(const Vector3& by_m) {
  return Pose(Eigen::Translation3d(by_m));
}

/// The frame with a body's error motion behind it.
Pose Erring(Pose frame, const BodyError& e) {
  return frame.translate(Vector3(e[0], e[1], e[2])).rotate(Rz(e[5]) * Ry(e[4]) * Rx(e[3]));
}

double Cubic(const CubicError& c, double t) {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

}  // namespace

Pose PoseOf(const BodyError& e) {
  return Erring(Pose::Identity(), e);
}

MachineErrors ErrorsAt(const MachineSettings& machine, const MachineCommand& at) {
  MachineErrors errors;
  errors.squareness_rad = machine.squareness_rad;
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const double t = (at[axis] - machine.centre[axis]) / machine.half[axis];
    for (std::size_t k = 0; k < kBodyErrors; ++k) errors.body[axis][k] = Cubic(machine.errors[axis][k], t);
  }
  return errors;
}

Pose X_MT(const MachineCommand& at, const MachineErrors& errors, double pivot_m) {
  const auto& [x_m, y_m, z_m, a_rad, b_rad] = at;
  const auto& s = errors.squareness_rad;
  const Vector3 dir_y = Rz(s[kSyx]) * Vector3::UnitY();
  const Vector3 dir_z = Ry(s[kSzx]) * Rx(s[kSzy]) * Vector3::UnitZ();
  const Matrix3 S_a = Rz(s[kSaz]) * Ry(s[kSay]);
  const Matrix3 S_b = Rz(s[kSbz]) * Rx(s[kSbx]);
  const Vector3 pivot = pivot_m * Vector3::UnitZ();
  Pose at_tool = Erring(Moved(y_m * dir_y), errors.body[1]);
  at_tool = Erring(at_tool.translate(z_m * dir_z), errors.body[2]);
  at_tool = Erring(at_tool.translate(pivot).rotate(S_a * Rx(a_rad) * S_a.transpose()), errors.body[3]);
  at_tool = Erring(at_tool.rotate(S_b * Ry(b_rad) * S_b.transpose()), errors.body[4]);
  return at_tool.translate(-pivot);
}

Pose X_MS(const MachineCommand& at, const MachineErrors& errors) {
  return Erring(Moved(at[0] * Vector3::UnitX()), errors.body[0]);
}

Pose X_SF(const MountSettings& mount, const BodyError& error) {
  return Erring(Moved({mount.x_m, mount.y_m, mount.z_m}).rotate(Rz(mount.yaw_rad)), error);
}

}  // namespace twinbench::sim
