#pragma once

#include <Eigen/Core>

#include "twin/core/rounding.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// Standard deviation of one reading, from the readings themselves: from second differences of neighbours within a
/// pass, and from differences of neighbours between two passes of one direction over the same stops. Structure in
/// the angle enlarges the first and structure in time the second, so the smaller one counts where they contradict
/// each other, and both where they do not: the smaller of two that differ by chance is too small. Single far values
/// do not enter. Not below 1e-9 of the range of `residual_rad`, for readings without any noise.
///
/// @param relative  Deviation of each reading in units of the one that is estimated, of readings that are means of
///                  unlike many; empty: all are alike.
/// @param same_rad  By how much angles differ at one stop. Of angles that an encoder shows it is more than their noise: else only
///                  readings of the same noise are at the same stop.
///
/// Standard uncertainty with n readings: about 1 / sqrt(n) of the value (600 readings: 4 %).
double EstimateNoise_rad(const Schedule& schedule, const Eigen::VectorXd& residual_rad,
                         const Eigen::VectorXd& relative = {}, double same_rad = units::urad);

}  // namespace twinbench::diagnose
