#pragma once

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"

namespace twinbench::measure {

/// Predicts where orders +1 and -1 meet the two PSDs, from the conical grating equation.
///
/// Written here a second time on purpose: this room must not share the formula with the simulated bench.
/// Each order leaves with unit wave vector k = t + sqrt(1 - |t|^2) N, where t = d - (d.N) N + m lambda rho g holds
/// the components along the grating (d incident direction, N normal, g across the grooves, rho lines per metre).
///
struct Spots {
  Vector4 at_m;  // [a_u, a_v, b_u, b_v], coordinates on the two PSDs; NaN if an order is evanescent or leaves away
                 // from its PSD
  Matrix4 slopes;  // per rad that the grating turns about x, y, z of L, and per m of dy
};

/// @param rotation_LG  Rotation of the grating frame G in L.
/// @param dy_m         Where the laser beam (along -y through the origin of L) meets the grating.
Spots SpotsAt(const Matrix3& rotation_LG, double dy_m, const BenchGeometry& geometry);

/// Without slopes.
Vector4 PredictSpots(const Matrix3& rotation_LG, double dy_m, const BenchGeometry& geometry);

/// The same for a motion [ez, ex, ey, dy].
Vector4 PredictSpots(const Vector4& motion, const BenchGeometry& geometry);

/// d spots / d motion.
Matrix4 SpotJacobian(const Vector4& motion, const BenchGeometry& geometry);

/// The rotation of a motion, Rz(ez) Ry(ey) Rx(ex).
Matrix3 MotionRotation(const Vector4& motion);

/// d [turn about x, y, z of L; dy] / d motion, where the rotation is that of the motion.
Matrix4 MotionAxes(const Vector4& motion, const Matrix3& rotation_LG);

/// Result of inverting the model.
struct MotionFit {
  bool converged = false;
  Vector4 motion = Vector4::Constant(kNaN);
  Matrix4 jacobian = Matrix4::Constant(kNaN);  // d spots / d motion there
};

/// Finds the motion whose spots are `spots_m`, by Newton's method from zero pose.
/// Converged means: the last step was below 1e-13 rad and m within 20 steps.
MotionFit SolveMotion(const Vector4& spots_m, const BenchGeometry& geometry);

}  // namespace twinbench::measure
