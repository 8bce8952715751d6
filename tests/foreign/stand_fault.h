#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tests/foreign/machine.h"

/// Where the light of the reference rotary bench goes, from the description of its frames alone: SI, laboratory
/// frame L, x along the dispersion, y along the grating's normal, z up, origin at the nominal spot. And runs of that
/// bench, and what can be wrong with it, in closed form.
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

struct StandStop {
  bool calibration = false;
  int setup = 0, pass = 0, direction = 1, position = 0;
  double t_s = 0.0, dwell_s = 1.0, temperature_degC = 20.0;
  double target_rad = 0.0, reference_rad = 0.0, shift_rad = 0.0;
  double sweep_yaw_rad = 0.0, sweep_tilt_rad = 0.0;  // in a calibration
};
using StandRun = std::vector<StandStop>;

struct StandDesign {
  int positions = 36;
  std::vector<int> shifts = {0, 1, 7, 11}, passes = {1, -1, -1, 1};
};
StandRun DrawRun(const StandDesign& design, Dice& dice);

double Duration_s(const StandRun& run);

/// What a fault does at one reading: the grating turns about the nominal spot and moves, the light changes.
struct Disturbed {
  Light light;
  double ex_rad = 0.0, ey_rad = 0.0, ez_rad = 0.0, dx_m = 0.0;
};

/// Errors of both tables and how everything is mounted: what the bench takes as unknown.
class Stand {
 public:
  Stand(const StandDesign& design, Dice& dice);
  /// Spots on psd_a_x, psd_a_y, psd_b_x, psd_b_y [m], in the order of the readings.
  Eigen::MatrixX4d Spots_m(const StandRun& run, const std::vector<Disturbed>& disturbed) const;

 private:
  Eigen::Isometry3d GratingAt(const StandStop& stop) const;
  std::size_t PositionOf(double angle_rad) const;
  std::vector<TableError> target_, reference_;  // by position
  std::vector<TableError> seat_, mount_;        // by set-up; the last mount is that of the calibration
};

/// A fault as drawn. Both functions get the whole run, because some faults remember.
struct StandFault {
  Truth truth;
  std::function<void(const StandRun& run, double size, std::vector<Disturbed>& disturbed)> of_body = {};
  std::function<void(const StandRun& run, double size, Eigen::MatrixX4d& shown_m)> of_electronics = {};
  double smallest = 1e-13, largest = 10.0;
};

struct StandKind {
  std::string name;
  StandFault (*draw)(Dice& dice, const StandRun& example);
};
const std::vector<StandKind>& ListedStandKinds();
const std::vector<StandKind>& UnlistedStandKinds();

/// A body that moves with the course of `shape`, by `size`.
/// @param member  &Disturbed::ex_rad, ...
StandFault Moving(Truth truth, double Disturbed::*member, std::function<double(const StandStop&)> shape);
/// The same of the laser's or the light's numbers.
StandFault Shining(Truth truth, double Light::*member, std::function<double(const StandStop&)> shape);
/// One channel, `size` times the shape of what it shows.
StandFault OnChannel(Truth truth, int channel, std::function<double(const StandStop&, double shown_m)> shape);

std::string ChannelName(int channel);

}  // namespace twinbench::foreign
