#pragma once

#include <vector>

#include "twin/benches/rotary_4dof/estimators/motion.h"
#include "twin/core/reading.h"

namespace twinbench::measure {

/// Bench minus autocollimator over the verification readings; a constant, the mounting, is taken off first.
struct Verification {
  int readings = 0;
  double rms_yaw_rad = kNaN;
  double max_yaw_rad = kNaN;
  double rms_tilt_rad = kNaN;
  double max_tilt_rad = kNaN;
  double u_yaw_rad = kNaN;  // expected of one difference: noise of the reading (without the autocollimator's)
  double u_tilt_rad = kNaN;
};

/// @param readings            The readings behind `motions`, in the same order.
/// @param autocollimator_gain  Shown over true.
/// Reference: Jywe et al. (2007), section 4.3. NaN with fewer than two valid verification readings.
Verification SummariseVerification(const std::vector<Motion>& motions, const std::vector<Reading>& readings,
                                   double autocollimator_gain);

}  // namespace twinbench::measure
