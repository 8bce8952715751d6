#pragma once

#include <Eigen/Core>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose::encoder {

/// Standard deviation of one reading, from the readings themselves: medians of second differences of neighbours
/// within a pass, and of differences of neighbours between two passes of one direction over the same stops; the
/// smaller of both, because structure in the angle enlarges the first and structure in time the second. Not below
/// 1e-9 of the range of `residual_rad`, for readings without any noise.
double EstimateNoise_rad(const Schedule& schedule, const Eigen::VectorXd& residual_rad);

}  // namespace twinbench::diagnose::encoder
