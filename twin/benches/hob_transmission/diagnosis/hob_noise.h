#pragma once

#include "twin/benches/hob_transmission/diagnosis/signals.h"

namespace twinbench::diagnose::hob {

/// Fills residual, sigma and whether it was stated, from samples. A group is as uncertain as its number of samples
/// says: errors of the steps of the hob's encoder count as white, which they are as far as the chain's own errors
/// move its readings over many steps.
///
/// @param left_rad  Samples x channels; rows without a value weigh nothing.
void SetResidual(const SignalContext& context, const Eigen::MatrixXd& left_rad, const Scenario& scenario,
                 LinearRun& run);

}  // namespace twinbench::diagnose::hob
