#pragma once

#include <limits>

namespace twinbench {

/// What a table may be asked to do, and what counts as wrong. Without further words anything goes but standing still.
struct TableLimits {
  double lower_rad = -std::numeric_limits<double>::infinity();        // soft limits, of the unwrapped angle
  double upper_rad = std::numeric_limits<double>::infinity();
  double in_position_rad = std::numeric_limits<double>::infinity();   // encoder against command once settled
  double following_rad = std::numeric_limits<double>::infinity();     // how far it may go the wrong way
  double stall_s = 5.0;                                               // for which it may stand still while it moves
  double move_timeout_s = 120.0;                                      // longer than any move
};

}  // namespace twinbench
