#include "twin/benches/rotary_4dof/estimators/grating_model.h"

#include <Eigen/LU>
#include <cmath>

namespace twinbench::measure {
namespace {

constexpr double kMotionStep = 1e-5;
constexpr double kLastMotionStep = 1e-13;
constexpr int kMostNewtonSteps = 20;

/// One PSD: order +1 shines on A (side = +1), order -1 on B (side = -1).
struct Psd {
  double side;
  double l1_m;
};

/// Unit direction of the diffracted order; NaN when evanescent.
Vector3 OrderDirection(const Matrix3& rotation_LG, double order, double sin_theta) {
  const Vector3 incident(0.0, -1.0, 0.0);
  const Vector3 normal = rotation_LG.col(1);
  const Vector3 along = incident - incident.dot(normal) * normal + order * sin_theta * rotation_LG.col(0);
  const double q = 1.0 - along.squaredNorm();
  return q > 0.0 ? Vector3(along + std::sqrt(q) * normal) : Vector3::Constant(kNaN);
}

/// Ray from `spot` along `direction` to the PSD's plane, in the PSD's u and v.
Eigen::Vector2d MeetPsd(const Vector3& spot, const Vector3& direction, const Psd& psd, double sin_theta) {
  const double cos_theta = std::sqrt(1.0 - sin_theta * sin_theta);
  const Vector3 nominal(psd.side * sin_theta, cos_theta, 0.0);
  const Vector3 u_axis(cos_theta, -psd.side * sin_theta, 0.0);
  const double length_m = (psd.l1_m - spot.dot(nominal)) / direction.dot(nominal);
  if (!(length_m > 0.0)) return Eigen::Vector2d::Constant(kNaN);
  const Vector3 hit = spot + length_m * direction;
  return {hit.dot(u_axis), hit.z()};
}

}  // namespace

Matrix3 MotionRotation(const Vector4& motion) {
  return (Eigen::AngleAxisd(motion[0], Vector3::UnitZ()) * Eigen::AngleAxisd(motion[2], Vector3::UnitY()) *
          Eigen::AngleAxisd(motion[1], Vector3::UnitX()))
      .toRotationMatrix();
}

Vector4 PredictSpots(const Matrix3& rotation_LG, double dy_m, const BenchGeometry& geometry) {
  const double sin_theta = geometry.SinTheta();
  const Vector3 spot(0.0, dy_m, 0.0);
  Vector4 spots_m;
  for (int p = 0; p < 2; ++p) {
    const Psd psd{p == 0 ? 1.0 : -1.0, geometry.psd_distance_m[static_cast<std::size_t>(p)]};
    const Vector3 direction = OrderDirection(rotation_LG, psd.side, sin_theta);
    spots_m.segment<2>(2 * p) = MeetPsd(spot, direction, psd, sin_theta);
  }
  return spots_m;
}

Vector4 PredictSpots(const Vector4& motion, const BenchGeometry& geometry) {
  return PredictSpots(MotionRotation(motion), motion[3], geometry);
}

Matrix4 SpotJacobian(const Vector4& motion, const BenchGeometry& geometry) {
  Matrix4 jacobian;
  for (int d = 0; d < kDofs; ++d) {
    const Vector4 step = kMotionStep * Vector4::Unit(d);
    jacobian.col(d) =
        (PredictSpots(Vector4(motion + step), geometry) - PredictSpots(Vector4(motion - step), geometry)) /
        (2.0 * kMotionStep);
  }
  return jacobian;
}

MotionFit SolveMotion(const Vector4& spots_m, const BenchGeometry& geometry) {
  MotionFit fit;
  Vector4 motion = Vector4::Zero();
  for (int i = 0; i < kMostNewtonSteps && motion.allFinite() && !fit.converged; ++i) {
    fit.jacobian = SpotJacobian(motion, geometry);
    const Vector4 step = fit.jacobian.partialPivLu().solve(spots_m - PredictSpots(motion, geometry));
    motion += step;
    fit.converged = step.cwiseAbs().maxCoeff() < kLastMotionStep;
  }
  if (fit.converged) fit.motion = motion;
  return fit;
}

}  // namespace twinbench::measure
