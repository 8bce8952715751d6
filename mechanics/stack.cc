#include "mechanics/stack.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mechanics/matrices.h"
#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

void CheckBody(const SymmetricBody& body) {
  RequirePositive(body.mass_kg, "stack: mass_kg");
  RequirePositive(body.transverse_inertia_kg_m2, "stack: transverse_inertia_kg_m2");
  RequirePositive(body.axial_inertia_kg_m2, "stack: axial_inertia_kg_m2");
}

void CheckTable(const TableParameters& table) {
  CheckBody(table.rotor);
  RequirePositive(table.axial_stiffness_N_m, "stack: axial_stiffness_N_m");
  RequirePositive(table.radial_stiffness_N_m, "stack: radial_stiffness_N_m");
  RequirePositive(table.tilt_stiffness_Nm_rad, "stack: tilt_stiffness_Nm_rad");
  RequirePositive(table.servo_Hz, "stack: servo_Hz");
  RequirePositive(table.torque_limit_Nm, "stack: torque_limit_Nm");
  RequireNotNegative(table.backlash_rad, "stack: backlash_rad");
  RequireNotNegative(table.friction.coulomb_Nm, "stack: friction.coulomb_Nm");
  RequirePositive(table.friction.static_ratio, "stack: friction.static_ratio");
  RequirePositive(table.friction.stribeck_rad_s, "stack: friction.stribeck_rad_s");
  RequirePositive(table.friction.presliding_rad, "stack: friction.presliding_rad");
  RequireNotNegative(table.friction.viscous_Nm_s, "stack: friction.viscous_Nm_s");
  RequireNotNegative(table.cable.stiffness_Nm_rad, "stack: cable.stiffness_Nm_rad");
  RequireNotNegative(table.cable.torque_Nm, "stack: cable.torque_Nm");
  RequireNotNegative(table.unbalance.kg_m, "stack: unbalance.kg_m");
  Check(table.scale);
}

/// Masses above one bearing and their transverse inertia about its origin, payload included.
struct Carried {
  double mass_kg = 0.0;
  double inertia_kg_m2 = 0.0;

  void Add(double body_mass_kg, double own_inertia, double height_m, double radius_m = 0.0) {
    mass_kg += body_mass_kg;
    inertia_kg_m2 += own_inertia + body_mass_kg * (height_m * height_m + 0.5 * radius_m * radius_m);
  }
};

Carried CarriedBy(const StackParameters& p, int table) {
  Carried carried;
  const double lift_m = table == 0 ? p.geometry.reference_height_m : 0.0;
  const auto add = [&](const SymmetricBody& body, double h) {
    carried.Add(body.mass_kg, body.transverse_inertia_kg_m2, h + body.height_m);
  };
  if (table == 0) add(p.table[0].rotor, 0.0);
  if (table == 0) add(p.housing, lift_m);
  add(p.table[1].rotor, lift_m);
  const double own = p.payload.mass_kg > 0.0 ? p.payload.inertia_kg_m2 : 0.0;
  carried.Add(p.payload.mass_kg, own, lift_m + p.payload.height_m, p.payload.radius_m);
  return carried;
}

}  // namespace

void Check(const StackParameters& p) {
  for (const TableParameters& table : p.table) CheckTable(table);
  CheckBody(p.housing);
  RequireNotNegative(p.payload.mass_kg, "stack: payload.mass_kg");
  RequirePositive(p.payload.inertia_kg_m2, "stack: payload.inertia_kg_m2");
  RequireNotNegative(p.payload.radius_m, "stack: payload.radius_m");
  RequireNotNegative(p.damping_ratio, "stack: damping_ratio");
  RequireNotNegative(p.gravity_m_s2, "stack: gravity_m_s2");
  RequirePositive(p.servo_period_s, "stack: servo_period_s");
  RequirePositive(p.step_s, "stack: step_s");
}

Vector12 BearingStiffness(const StackParameters& p) {
  Vector12 k;
  for (int t = 0; t < 2; ++t) {
    const TableParameters& table = p.table[static_cast<std::size_t>(t)];
    const double radial = table.radial_stiffness_N_m;
    const double tilt = table.tilt_stiffness_Nm_rad;
    k.segment<kPerTable>(kPerTable * t) << radial, radial, table.axial_stiffness_N_m, tilt, tilt, 0.0;
  }
  return k;
}

Vector12 BearingDamping(const StackParameters& p) {
  Vector12 inertia;
  for (int t = 0; t < 2; ++t) {
    const Carried c = CarriedBy(p, t);
    inertia.segment<kPerTable>(kPerTable * t) << c.mass_kg, c.mass_kg, c.mass_kg, c.inertia_kg_m2, c.inertia_kg_m2,
        0.0;
  }
  return 2.0 * p.damping_ratio * BearingStiffness(p).cwiseProduct(inertia).cwiseSqrt();
}

Vector12 BearingPreload(const StackParameters& p) {
  Vector12 force = Vector12::Zero();
  const double reference_kg = p.table[1].rotor.mass_kg;
  force[2] = p.gravity_m_s2 * (reference_kg + p.housing.mass_kg + p.table[0].rotor.mass_kg);
  force[kPerTable + 2] = p.gravity_m_s2 * reference_kg;
  return force;
}

Eigen::Matrix2d SpinInertia(const StackParameters& p) {
  const Payload& load = p.payload;
  const double reference =
      p.table[1].rotor.axial_inertia_kg_m2 +
      (load.mass_kg > 0.0 ? load.inertia_kg_m2 + load.mass_kg * load.radius_m * load.radius_m : 0.0);
  const double target = p.table[0].rotor.axial_inertia_kg_m2 + p.housing.axial_inertia_kg_m2 + reference;
  return (Eigen::Matrix2d() << target, reference, reference, reference).finished();
}

BearingPose BearingOf(const Vector12& q, int table) {
  const auto b = q.segment<kPerTable>(kPerTable * table);
  return {b[0], b[1], b[2], b[3], b[4]};
}

namespace {

/// Its eigenvalues are the squares of the natural frequencies: of two rotors that turn freely, whose rows are zero, and ten more.
Eigen::MatrixXd SquaredFrequencies(StackDynamics& dynamics) {
  const Vector12 root = BearingStiffness(dynamics.parameters()).cwiseSqrt();
  return root.asDiagonal() * dynamics.InverseMass(Vector12::Zero()) * root.asDiagonal();
}

}  // namespace

double HighestFrequency(StackDynamics& dynamics) {
  return std::sqrt(LargestEigenvalueOf(SquaredFrequencies(dynamics)));
}

double LowestFrequency(StackDynamics& dynamics) {
  Eigen::MatrixXd held = SquaredFrequencies(dynamics);
  for (int t = 0; t < 2; ++t) held(SpinIndex(t), SpinIndex(t)) = held.norm();  // no longer free: above all others
  return 1.0 / std::sqrt(LargestEigenvalueOf(InverseOf(held)));
}

int SubSteps(StackDynamics& dynamics) {
  const StackParameters& p = dynamics.parameters();
  const double longest_s = std::min(p.step_s, 2.0 / HighestFrequency(dynamics));
  return static_cast<int>(std::ceil(p.servo_period_s / longest_s - 1e-9));
}

}  // namespace twinbench::mechanics
