#include "mechanics/drive_loads.h"

#include <cmath>

namespace twinbench::mechanics {
namespace {

double CableTorque_Nm(const CableParameters& cable, double rotor_rad) {
  return -cable.stiffness_Nm_rad * rotor_rad - cable.torque_Nm * std::sin(rotor_rad - cable.azimuth_rad);
}

/// A horizontal force at `height_m` above the origin of a table, on the coordinates of its bearing.
void AddForce(const Eigen::Vector2d& force_N, double height_m, int table, Vector12& load) {
  const int i = kPerTable * table;
  load.segment<2>(i) += force_N;
  load[i + 3] -= height_m * force_N.y();
  load[i + 4] += height_m * force_N.x();
}

Eigen::Vector2d Towards(double azimuth_rad) {
  return {std::cos(azimuth_rad), std::sin(azimuth_rad)};
}

}  // namespace

bool HasLoads(const StackParameters& p) {
  for (const TableParameters& t : p.table) {
    if (t.cable.stiffness_Nm_rad != 0.0 || t.cable.torque_Nm != 0.0 || t.unbalance.kg_m != 0.0) return true;
  }
  return false;
}

Vector12 DriveLoads(const StackParameters& p, const Eigen::Vector2d& rotors_rad,
                    const Eigen::Vector2d& speeds_rad_s) {
  Vector12 load = Vector12::Zero();
  for (int t = 0; t < 2; ++t) {
    load[SpinIndex(t)] = CableTorque_Nm(p.table[static_cast<std::size_t>(t)].cable, rotors_rad[t]);
  }
  const Unbalance &target = p.table[0].unbalance, &reference = p.table[1].unbalance;
  const double body_rad = rotors_rad[0] + p.geometry.reseat_rad;  // of the reference's stator in the laboratory
  const double speed_rad_s = speeds_rad_s[0] + speeds_rad_s[1];
  const double on_target_N = target.kg_m * speeds_rad_s[0] * speeds_rad_s[0];
  const double on_reference_N = reference.kg_m * speed_rad_s * speed_rad_s;
  const double heavy_rad = rotors_rad[1] + reference.azimuth_rad;
  AddForce(on_target_N * Towards(rotors_rad[0] + target.azimuth_rad), p.table[0].rotor.height_m, 0, load);
  const double height_m = p.table[1].rotor.height_m;
  AddForce(on_reference_N * Towards(heavy_rad), height_m, 1, load);
  AddForce(on_reference_N * Towards(body_rad + heavy_rad), p.geometry.reference_height_m + height_m, 0, load);
  return load;
}

}  // namespace twinbench::mechanics
