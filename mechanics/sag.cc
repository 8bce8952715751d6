#include "mechanics/sag.h"

#include <cmath>

namespace twinbench::mechanics {
namespace {

/// Mass and first moment [kg, kg m] of bodies, in the laboratory frame.
struct Weights {
  double mass_kg = 0.0;
  Vector3 moment_kg_m = Vector3::Zero();

  void Add(double body_mass_kg, const Vector3& p_m) {
    mass_kg += body_mass_kg;
    moment_kg_m += body_mass_kg * p_m;
  }
};

/// Adds the slopes of one bearing and rotor that carry `weights`. `X_LB` is the pose of the undeflected stator.
void AddSlopes(const Pose& X_LB, const Vector12& q, int table, const Weights& weights, double g, Vector12& slope) {
  const BearingPose b = BearingOf(q, table);
  const Vector3 pivot = X_LB * Vector3(b.x_m, b.y_m, b.z_m);
  const Vector3 arm = weights.moment_kg_m - weights.mass_kg * pivot;
  const Matrix3 tilted = X_LB.linear() * RotationX(b.rx_rad);
  const Vector3 axis_ry = tilted.col(1);
  const Vector3 axis_spin = (tilted * RotationY(b.ry_rad)).col(2);
  const int i = kPerTable * table;
  slope.segment<3>(i) = g * weights.mass_kg * X_LB.linear().row(2).transpose();
  slope[i + 3] = g * X_LB.linear().col(0).cross(arm).z();
  slope[i + 4] = g * axis_ry.cross(arm).z();
  slope[i + 5] = g * axis_spin.cross(arm).z();
}

Vector3 Above(double height_m) {
  return {0.0, 0.0, height_m};
}

}  // namespace

Vector12 WeightGradient(const StackParameters& p, const Vector12& q) {
  const ChainGeometry& geometry = p.geometry;
  const Pose X_LB0 = Pose::Identity();  // the slope does not know where the bench stands
  const Pose X_LT = X_LB0 * ToPose(BearingOf(q, 0)) * Pose(RotationZ(q[SpinIndex(0)]));
  const Pose X_LS = X_LT * BodyOnTarget(geometry);
  const Pose X_LR = X_LS * ToPose(BearingOf(q, 1)) * Pose(RotationZ(q[SpinIndex(1)]));
  const Vector3 p_RP(p.payload.radius_m * std::cos(p.payload.azimuth_rad),
                     p.payload.radius_m * std::sin(p.payload.azimuth_rad), p.payload.height_m);

  Vector12 slope;
  Weights weights;
  weights.Add(p.payload.mass_kg, X_LR * p_RP);
  weights.Add(p.table[1].rotor.mass_kg, X_LR * Above(p.table[1].rotor.height_m));
  AddSlopes(X_LS, q, 1, weights, p.gravity_m_s2, slope);
  weights.Add(p.housing.mass_kg, X_LS * Above(p.housing.height_m));
  weights.Add(p.table[0].rotor.mass_kg, X_LT * Above(p.table[0].rotor.height_m));
  AddSlopes(X_LB0, q, 0, weights, p.gravity_m_s2, slope);
  return slope;
}

Vector12 StaticDeflection(const StackParameters& p, double target_rad, double reference_rad) {
  const Vector12 stiffness = BearingStiffness(p);
  const Vector12 preload = BearingPreload(p);
  Vector12 q = Vector12::Zero();
  q[SpinIndex(0)] = target_rad;
  q[SpinIndex(1)] = reference_rad;
  for (int round = 0; round < 10; ++round) {
    Vector12 next = q;
    const Vector12 force = preload - WeightGradient(p, q);
    for (int i = 0; i < kCoordinates; ++i) {
      if (stiffness[i] > 0.0) next[i] = force[i] / stiffness[i];
    }
    const double change = (next - q).cwiseAbs().maxCoeff();
    q = next;
    if (change < 1e-18) break;  // 1e-18 rad or m: rounding of deflections of a micrometre is 1e-22
  }
  return q;
}

bool SagIsConstant(const StackParameters& p) {
  return p.payload.mass_kg * p.payload.radius_m == 0.0 && p.geometry.centring_m.isZero(0.0) &&
         p.geometry.mount_tilt_rad.isZero(0.0);
}

}  // namespace twinbench::mechanics
