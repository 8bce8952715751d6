#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// Of some rows, those that lie elsewhere than between what was found there and what was found at one of the two readings
/// before or behind, to which it jumps: where an axis turns round, or a step falls between readings, one or two of them are
/// on their way, and a cause that is told to first order has them on either side.
/// @param found  What all causes show, by row; `left` what they leave.
std::vector<int> AwayFromJumps(std::vector<int> rows, const LinearRun& run, const Eigen::VectorXd& found,
                               const Eigen::VectorXd& left);

}  // namespace twinbench::diagnose
