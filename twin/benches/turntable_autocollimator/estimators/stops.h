#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/reading.h"

/// The bench turntable_autocollimator (Guo et al. 2014): a multi-tooth table on the turntable under test turns its
/// mirror back by the turntable's nominal angle, and an autocollimator reads what is left.
namespace twinbench::separate::turntable {

/// One stop as read. The nominal angles may be unwrapped; both count counter-clockwise seen from above, so that
/// their sum stays the same while one follows the other: the set-up's shift. A stop with NaN in x or y is not used.
struct TurntableStop {
  int setup = 0;  // one tilt and one shift of the multi-tooth table against the turntable
  int pass = 0;
  int direction = 1;
  double turntable_rad = kNaN;   // nominal
  double multitooth_rad = kNaN;  // nominal
  double x_rad = kNaN;           // autocollimator, about the turntable's axis if the crosshair has no roll
  double y_rad = kNaN;
};

inline constexpr int kFewestPositions = 3;  // of a full circle

struct SetUp {
  int label = 0;  // TurntableStop::setup
  int row = 0;    // of teeth
  int shift = 0;  // (position + tooth of its row) mod n
};

struct GridStop {
  std::size_t stop = 0;  // index into the stops
  int setup = 0;         // index into StopGrid::setups
  int position = 0;      // of the turntable
  int tooth = 0;         // row * n + tooth of the row
};

/// The stops on a circle of n even positions. Set-ups whose shifts differ by whole steps use the same teeth; these
/// form a row. A shift by a part of a step (1 deg where the step is 5 deg) brings another row into play.
struct StopGrid {
  int n = 0;
  double offset_rad = 0.0;             // of position 0, in [0, step)
  std::vector<double> row_offset_rad;  // of tooth 0 of each row, in [0, step)
  std::vector<SetUp> setups;
  std::vector<GridStop> stops;  // usable ones

  double Step_rad() const;
  double Position_rad(int position) const { return offset_rad + position * Step_rad(); }
  double Tooth_rad(int tooth) const;  // own angle in [0, 2 pi)
  int Teeth() const { return n * static_cast<int>(row_offset_rad.size()); }
};

/// Finds positions, rows and set-ups in the nominal angles.
///
/// @param positions  n; 0: count the distinct turntable angles.
/// @throws InputError if the angles are not on an even grid (to a thousandth of a step), if turntable + multi-tooth
///         angle differs inside a set-up, if there are fewer than 3 positions or no usable stop.
StopGrid FindGrid(const std::vector<TurntableStop>& stops, int positions = 0);

/// x and y of the grid's stops.
struct Readings {
  Eigen::VectorXd x_rad;
  Eigen::VectorXd y_rad;
};
Readings Collect(const std::vector<TurntableStop>& stops, const StopGrid& grid);

}  // namespace twinbench::separate::turntable
