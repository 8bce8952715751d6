#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tests/foreign/dice.h"
#include "tests/foreign/grating_stand.h"

/// One run of the rotary bench: where and when each reading is taken, and what may disturb it.
namespace twinbench::foreign {

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

}  // namespace twinbench::foreign
