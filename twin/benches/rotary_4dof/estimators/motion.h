#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "twin/core/reading.h"

namespace twinbench::measure {

/// The four motions that the bench reads. Every 4-vector and 4x4 matrix of this room has this order:
/// [ez rad, ex rad, ey rad, dy m].
enum class Dof { kEz, kEx, kEy, kDy };
inline constexpr int kDofs = 4;
inline constexpr std::array<const char*, kDofs> kDofNames = {"ez", "ex", "ey", "dy"};

/// Calibration parameters that a motion depends on: gains of the four channels in scan order, roll of PSD A and B.
inline constexpr int kCalibrationParameters = 6;

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;
using Matrix46 = Eigen::Matrix<double, kDofs, kCalibrationParameters>;
using Matrix6 = Eigen::Matrix<double, kCalibrationParameters, kCalibrationParameters>;

/// Pose of the grating at the laser spot in one reading: rotation Rz(ez) Ry(ey) Rx(ex) and the place dy where the
/// laser beam meets the grating, both in L.
struct Motion {
  int reading = 0;
  int setup = 0;
  int pass = 0;
  int direction = 1;
  int position = 0;
  Phase phase = Phase::kFullCircle;
  Time time{};
  double target_rad = kNaN;     // commanded, unwrapped
  double reference_rad = kNaN;  // commanded, unwrapped

  ReadingStatus status = ReadingStatus::kMissing;  // anything but kOk leaves all numbers below NaN
  std::string reason = "not evaluated";            // in plain words, empty when status is kOk
  double ez_rad = kNaN;
  double ex_rad = kNaN;
  double ey_rad = kNaN;
  double dy_m = kNaN;

  bool covariance_known = false;                     // false: estimate it from residuals
  Matrix4 cov = Matrix4::Constant(kNaN);             // random part: noise of the block, quantisation
  Matrix4 cov_systematic = Matrix4::Constant(kNaN);  // of the calibration: common to all readings, kept apart
  Matrix46 d_calibration =
      Matrix46::Constant(kNaN);  // d motion / d (gains, rolls): correlates the systematic parts

  Vector4 Values() const { return {ez_rad, ex_rad, ey_rad, dy_m}; }
  void SetValues(const Vector4& v);
};

inline void Motion::SetValues(const Vector4& v) {
  ez_rad = v[0];
  ex_rad = v[1];
  ey_rad = v[2];
  dy_m = v[3];
}

}  // namespace twinbench::measure
