#pragma once

#include <vector>

#include "twin/benches/hob_transmission/diagnosis/hob_run.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/analysis.h"

/// From the search over groups of samples back to the readings.
namespace twinbench::diagnose::hob {

/// Simulated runs without effect: fewer where a run has many rows.
int NullRuns(const HobRun& hob, int wanted);

/// Samples that were left out because they lie far outside, as a cause; none if there are none.
/// @param excluded  Causes that are not in the catalogue.
std::vector<Cause> OutlierCauses(const HobRun& hob, const std::vector<std::string>& excluded);

/// Analyses; where some of what is found is of the second order, once more with no more causes than the others.
///
/// Of the second order is what is no larger than the forward model leaves out, and what has the same signature as a
/// cause that was taken before: a wave at the hob's angle is one at the table's to the second order, and a strong
/// one leaves their difference.
Analysis AnalyseToFirstOrder(const HobRun& hob, const std::vector<Family>& families, AnalysisOptions how);

/// Gives structure without a name a value at every reading, between those of the groups; makes one cause of all
/// outliers, whether they were found as samples or as groups; counts readings; fills the table of harmonics.
void ToReadings(const HobRun& hob, DiagnosisRun& result);

}  // namespace twinbench::diagnose::hob
