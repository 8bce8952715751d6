#pragma once

#include "twin/benches/hob_transmission/diagnosis/hob_run.h"

namespace twinbench::diagnose::hob {

/// Looks for single samples of m that lie far outside, against the three before and the three behind them: a step
/// or a wave is near the one or the other. What is far is told by how all samples scatter so. Finds none if the
/// noise as a whole has heavy tails.
/// @param left_rad  One entry a sample.
Outliers FindOutliers(const SignalContext& context, const Eigen::VectorXd& left_rad);

}  // namespace twinbench::diagnose::hob
