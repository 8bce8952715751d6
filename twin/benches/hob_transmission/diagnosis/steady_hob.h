#pragma once

#include "twin/benches/hob_transmission/diagnosis/signals.h"

namespace twinbench::diagnose::hob {

/// The hob's angle at each sample as far as it follows the table: (table - fit of m) / ratio.
///
/// Faults of the hob's signals repeat with its lines, thousands of them a turn. Their phase must not be taken from
/// the reading itself: a signature that has the reading's own noise in it explains that noise. The fit of m has for
/// each set-up a constant of every pass, a slope in time, and the orders of the table up to 12, of hob, mesh and
/// worm; its own noise is that of a hundredth of the samples. Not included: motions that m has besides, which blur
/// the phase by lines / ratio times their size.
Eigen::VectorXd SteadyHob_rad(const SignalContext& context);

}  // namespace twinbench::diagnose::hob
