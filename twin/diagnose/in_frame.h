#pragma once

#include <Eigen/Core>

#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"

namespace twinbench::diagnose {

/// What another scenario leaves of the readings of `frame`, with the free unknowns as they would have moved there:
/// unknowns have other slopes where a cause is in the twin, and would leave of themselves what no cause has to do
/// with.
/// @param extended  The same readings against that scenario; other unknowns: its residual as it is.
/// @param noise     Of the readings.
Eigen::VectorXd LeftInFrame(const LinearRun& extended, const LinearRun& frame, const NoiseModel& noise);

}  // namespace twinbench::diagnose
