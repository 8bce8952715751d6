#pragma once

#include <Eigen/Geometry>

/// Where the light of the reference rotary bench goes, from the description of its frames alone: SI, laboratory
/// frame L, x along the dispersion, y along the grating's normal, z up, origin at the nominal spot.
namespace twinbench::foreign {

/// Six errors of a rotary table at its origin.
struct TableError {
  double ex_rad = 0.0, ey_rad = 0.0, ez_rad = 0.0, dx_m = 0.0, dy_m = 0.0, dz_m = 0.0;
};

/// How the two stacked tables stand.
struct Stacking {
  double target_rad = 0.0, reference_rad = 0.0, shift_rad = 0.0;
  bool is_reseated = true;       // else the grating is re-clamped
  TableError target, reference;  // the reference's in the frame of its base
  TableError seat;               // of the reference's body on the target
};

/// What else the light depends on.
struct Light {
  double wavelength_m = 650e-9, laser_yaw_rad = 0.0, laser_pitch_rad = 0.0;
  double distance_a_m = 0.120, distance_b_m = 0.120;
};

struct Spots {
  double u_a_m, v_a_m, u_b_m, v_b_m;
};

Eigen::Isometry3d PoseOf(const TableError& error);
/// Pose of the grating in L.
Eigen::Isometry3d GratingOn(const Stacking& stacking);
/// Both first orders on their detectors, by the grating equation for directions in space.
Spots ShineOn(const Eigen::Isometry3d& X_LG, const Light& light);

}  // namespace twinbench::foreign
