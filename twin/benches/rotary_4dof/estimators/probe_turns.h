#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/reading_column.h"

/// What probes showed of an axis that turned, turn by turn.
namespace twinbench::separate::rotary {

/// Whole turns of one mounting at the same angles.
struct ProbeTurns {
  int setup = 0;
  Eigen::VectorXd angle_rad;           // n, evenly spaced over a turn, in the laboratory's sense
  std::vector<Eigen::MatrixXd> shown;  // by column asked for: turns x n; empty: that column has no numbers
  bool is_interpolated = false;        // readings lay at other angles: linearly between two of them
  int incomplete = 0;                  // turns with a gap in all columns, which are left out
  int Turns() const;
};

/// @param columns  Those that are asked for.
/// @return one entry a mounting that has a whole turn; readings that are no part of one are left out.
///
/// Passes of a mounting are taken together, whichever way they went. As many angles a turn as readings usually are.
std::vector<ProbeTurns> TurnsOf(const std::vector<Reading>& readings, const std::vector<Quantity>& columns);

}  // namespace twinbench::separate::rotary
