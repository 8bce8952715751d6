#pragma once

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose {

/// A scenario that has single disturbed readings is not wrong if there are some: outliers that are no more and no
/// larger than it states are no cause any more, but a remark on the noise.
void LeaveOutStatedOutliers(const Scenario& scenario, DiagnosisRun& result);

}  // namespace twinbench::diagnose
