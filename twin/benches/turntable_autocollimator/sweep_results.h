#pragma once

#include "twin/benches/turntable_autocollimator/estimators/collimator_sweep.h"
#include "twin/report/evaluation.h"

namespace twinbench::benches::turntable {

/// Takes single readings of a sweep out that lie far from their neighbours, and says so.
/// @return the others, and all that are of no sweep.
std::vector<Reading> WithoutFarOfSweep(std::vector<Reading> readings, report::Evaluation& evaluation);

/// Adds what a sweep says of the autocollimator to results.json (`autocollimator`) and the summary.
void AddSweep(const separate::turntable::CollimatorSweep& sweep, report::Evaluation& evaluation);

}  // namespace twinbench::benches::turntable
