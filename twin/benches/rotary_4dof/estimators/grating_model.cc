#include "twin/benches/rotary_4dof/estimators/grating_model.h"

#include <cmath>

#include "twin/core/linear_algebra.h"

namespace twinbench::measure {
namespace {

constexpr double kLastMotionStep = 1e-13;
constexpr int kMostNewtonSteps = 20;
using Matrix34 = Eigen::Matrix<double, 3, 4>;

/// One PSD: order +1 shines on A (side = +1), order -1 on B (side = -1).
struct Psd {
  double side;
  double l1_m;
};

/// A vector, and what it changes by per rad that the grating turns about x, y, z of L and per m of dy.
struct Moving {
  Vector3 at;
  Matrix34 slopes;
};

/// An axis of the grating.
Moving Turning(const Vector3& axis) {
  Moving turning{axis, Matrix34::Zero()};
  for (int k = 0; k < 3; ++k) turning.slopes.col(k) = Vector3::Unit(k).cross(axis);
  return turning;
}

/// Unit direction of the diffracted order; NaN when evanescent.
Moving OrderDirection(const Matrix3& rotation_LG, double order, double sin_theta) {
  const Vector3 incident(0.0, -1.0, 0.0);
  const Moving across = Turning(rotation_LG.col(0)), normal = Turning(rotation_LG.col(1));
  const double into = incident.dot(normal.at);
  const Vector3 along = incident - into * normal.at + order * sin_theta * across.at;
  const Matrix34 d_along =
      order * sin_theta * across.slopes - into * normal.slopes - normal.at * (incident.transpose() * normal.slopes);
  const double q = 1.0 - along.squaredNorm();
  if (!(q > 0.0)) return {Vector3::Constant(kNaN), Matrix34::Constant(kNaN)};
  const double out = std::sqrt(q);
  return {along + out * normal.at, d_along + out * normal.slopes - normal.at * (along.transpose() * d_along) / out};
}

/// Ray from `spot` along `direction` to the PSD's plane, in the PSD's u and v, and their slopes.
void MeetPsd(const Moving& spot, const Moving& direction, const Psd& psd, double sin_theta,
             Eigen::Ref<Eigen::Vector2d> met_m, Eigen::Ref<Eigen::Matrix<double, 2, 4>> slopes) {
  const double cos_theta = std::sqrt(1.0 - sin_theta * sin_theta);
  const Vector3 nominal(psd.side * sin_theta, cos_theta, 0.0);
  const double towards = direction.at.dot(nominal), length_m = (psd.l1_m - spot.at.dot(nominal)) / towards;
  Eigen::Matrix<double, 2, 3> axes;  // u, v
  axes << cos_theta, -psd.side * sin_theta, 0.0, 0.0, 0.0, 1.0;
  met_m = length_m > 0.0 ? Eigen::Vector2d(axes * (spot.at + length_m * direction.at))
                         : Eigen::Vector2d::Constant(kNaN);
  const Matrix34 at_length = spot.slopes + length_m * direction.slopes;
  slopes = axes * (at_length - direction.at * (nominal.transpose() * at_length) / towards);
}

}  // namespace

Matrix3 MotionRotation(const Vector4& motion) {
  return (Eigen::AngleAxisd(motion[0], Vector3::UnitZ()) * Eigen::AngleAxisd(motion[2], Vector3::UnitY()) *
          Eigen::AngleAxisd(motion[1], Vector3::UnitX()))
      .toRotationMatrix();
}

Matrix4 MotionAxes(const Vector4& motion, const Matrix3& rotation_LG) {
  Matrix4 axes = Matrix4::Zero();
  axes.col(0) << 0.0, 0.0, 1.0, 0.0;
  axes.col(1) << rotation_LG.col(0), 0.0;
  axes.col(2) << -std::sin(motion[0]), std::cos(motion[0]), 0.0, 0.0;
  axes(3, 3) = 1.0;
  return axes;
}

Spots SpotsAt(const Matrix3& rotation_LG, double dy_m, const BenchGeometry& geometry) {
  const double sin_theta = geometry.SinTheta();
  Moving spot{{0.0, dy_m, 0.0}, Matrix34::Zero()};
  spot.slopes(1, 3) = 1.0;
  Spots spots;
  for (int p = 0; p < 2; ++p) {
    const Psd psd{p == 0 ? 1.0 : -1.0, geometry.psd_distance_m[static_cast<std::size_t>(p)]};
    MeetPsd(spot, OrderDirection(rotation_LG, psd.side, sin_theta), psd, sin_theta, spots.at_m.segment<2>(2 * p),
            spots.slopes.middleRows<2>(2 * p));
  }
  return spots;
}

Vector4 PredictSpots(const Matrix3& rotation_LG, double dy_m, const BenchGeometry& geometry) {
  return SpotsAt(rotation_LG, dy_m, geometry).at_m;
}

Vector4 PredictSpots(const Vector4& motion, const BenchGeometry& geometry) {
  return PredictSpots(MotionRotation(motion), motion[3], geometry);
}

Matrix4 SpotJacobian(const Vector4& motion, const BenchGeometry& geometry) {
  const Matrix3 rotation_LG = MotionRotation(motion);
  return SpotsAt(rotation_LG, motion[3], geometry).slopes * MotionAxes(motion, rotation_LG);
}

MotionFit SolveMotion(const Vector4& spots_m, const BenchGeometry& geometry) {
  MotionFit fit;
  Vector4 motion = Vector4::Zero();
  for (int i = 0; i < kMostNewtonSteps && motion.allFinite() && !fit.converged; ++i) {
    const Matrix3 rotation_LG = MotionRotation(motion);
    const Spots spots = SpotsAt(rotation_LG, motion[3], geometry);
    fit.jacobian = spots.slopes * MotionAxes(motion, rotation_LG);
    const Vector4 step = SolveFour(fit.jacobian, spots_m - spots.at_m);
    motion += step;
    fit.converged = step.cwiseAbs().maxCoeff() < kLastMotionStep;
  }
  if (fit.converged) fit.motion = motion;
  return fit;
}

}  // namespace twinbench::measure
