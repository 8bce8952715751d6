#pragma once

#include <optional>
#include <string>

#include "twin/diagnose/engine/analysis.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_causes.h"

namespace twinbench::diagnose::turntable {

/// Single readings of an axis that lie so far outside the noise that nothing can be said before they are left out.
///
/// A position is read a few times only: one value far outside drags its error along and makes its fellows look
/// disturbed, too. So the farthest is taken out first and the rest looked at again. What neighbouring readings have
/// in common is no disturbance.
/// @return  With the rows that `repaired` silences; nothing if there are none, or more than one in twenty.
std::optional<NoiseCause> FindOutliers(const LinearRun& run);

/// Together with those that an analysis found behind them, which are taken out of its repairs.
void TakeFurther(Analysis& analysis, NoiseCause& outlying);

/// Median of the stated standard uncertainties.
double UsualSigma_rad(const LinearRun& run);

}  // namespace twinbench::diagnose::turntable
