#include "twin/benches/turntable_autocollimator/estimators/tilt_squared.h"

#include <cmath>
#include <map>

#include "twin/core/linear_algebra.h"
#include "twin/separate/mean.h"

namespace twinbench::separate::turntable {
namespace {

/// y = zero + cosine cos th + sine sin th of a set-up.
struct Lean {
  Eigen::Vector3d of_angle = Eigen::Vector3d::Zero();

  double Along_rad(double angle_rad) const { return of_angle[1] * std::cos(angle_rad) + of_angle[2] * std::sin(angle_rad); }
  double Across_rad(double angle_rad) const { return of_angle[1] * std::sin(angle_rad) - of_angle[2] * std::cos(angle_rad); }
};

std::map<int, Lean> LeansOf(const std::vector<TiltReading>& readings) {
  struct Normal {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
  };
  std::map<int, Normal> normals;
  for (const TiltReading& r : readings) {
    if (!std::isfinite(r.y_rad)) continue;
    const Eigen::Vector3d row(1.0, std::cos(r.angle_rad), std::sin(r.angle_rad));
    normals[r.setup].matrix += row * row.transpose();
    normals[r.setup].right += r.y_rad * row;
  }
  constexpr double kTold = 1e-3;  // of the largest eigenvalue: an arc of 60 deg and more
  std::map<int, Lean> leans;
  for (const auto& [setup, normal] : normals) {
    const Eigen::Vector3d values = EigenvaluesOfSymmetric(normal.matrix);
    if (values[0] > kTold * values[2]) leans[setup].of_angle = SolveNormal(normal.matrix, normal.right).x;
  }
  return leans;
}

}  // namespace

Eigen::VectorXd TiltSquared_rad(const std::vector<TiltReading>& readings) {
  std::map<int, Lean> leans = LeansOf(readings);
  std::map<int, Mean> pitch_rad;  // by face
  for (const TiltReading& r : readings) {
    if (!std::isfinite(r.y_rad) || !leans.contains(r.setup)) continue;
    const Lean& lean = leans.at(r.setup);
    pitch_rad[r.face].Add(r.y_rad - lean.of_angle[0] - lean.Along_rad(r.angle_rad));
  }
  Eigen::VectorXd shown_rad = Eigen::VectorXd::Zero(std::ssize(readings));
  for (Eigen::Index i = 0; i < shown_rad.size(); ++i) {
    const TiltReading& r = readings[static_cast<std::size_t>(i)];
    const auto lean = leans.find(r.setup);
    if (lean == leans.end() || !pitch_rad.contains(r.face)) continue;
    shown_rad[i] = -lean->second.Across_rad(r.angle_rad) *
                   (0.5 * lean->second.Along_rad(r.angle_rad) + pitch_rad.at(r.face).Value());
  }
  return shown_rad;
}

}  // namespace twinbench::separate::turntable
