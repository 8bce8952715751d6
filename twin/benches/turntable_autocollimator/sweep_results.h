#pragma once

#include "twin/benches/turntable_autocollimator/estimators/collimator_sweep.h"
#include "twin/report/evaluation.h"

namespace twinbench::benches::turntable {

/// Adds what a sweep says of the autocollimator to results.json (`autocollimator`) and the summary.
void AddSweep(const separate::turntable::CollimatorSweep& sweep, report::Evaluation& evaluation);

}  // namespace twinbench::benches::turntable
