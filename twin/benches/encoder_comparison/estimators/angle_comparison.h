#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::measure {

/// What an angle device shows against its reference.
struct AngleComparison {
  std::vector<int> used;      // indices into the readings
  Eigen::VectorXd error_rad;  // measured - reference, one a used reading
  int left_out = 0;           // readings without a value

  Eigen::VectorXd mean_rad;  // of each set-up, in the order of their numbers

  // Of error_rad without the mean of its set-up; NaN without readings.
  double rms_rad = kNaN;
  double range_rad = kNaN;         // largest - smallest
  double mean_forward_rad = kNaN;  // of readings with direction +1; NaN if there are none
  double mean_backward_rad = kNaN;
};

/// Takes the difference of both devices, with the turns that one of them may not count taken out: it stays
/// continuous from reading to reading within a set-up, and the first lies within half a turn of zero.
///
/// Five readings at most that are far off leave no trace in those behind them. A device that loses half a turn or
/// more between two readings is not told from one that wraps.
AngleComparison CompareAngles(const std::vector<Reading>& readings);

}  // namespace twinbench::measure
