#pragma once

#include <optional>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/core/reading.h"
#include "twin/core/rounding.h"
#include "twin/diagnose/engine/linear_run.h"

/// Runs of one plan as one run with less noise: what repeats is left, so that a diagnosis sees smaller causes in the
/// mean than in any of them. What happens once is the smaller in it.
namespace twinbench::diagnose {

/// Reading by reading the mean of every number that the bench's columns have; times are those of the last run. A reading
/// that one of the runs lacks is missing.
/// @param runs  At least one.
/// @return nothing if they are not runs of one plan: other stops, or lines that were timed on their way.
std::optional<std::vector<Reading>> MeanOfRuns(const std::vector<const std::vector<Reading>*>& runs,
                                               const BenchFormat& format);

/// Whether reading by reading they are of the same stops, and no lines that were timed on their way.
bool AreOfOnePlan(const std::vector<Reading>& a, const std::vector<Reading>& b);

/// Of how many runs it is the mean; 1 unless MeanOfRuns made it.
int RunsIn(const std::vector<Reading>& readings);

/// Stated uncertainties become those of the mean. Where noise is smaller than the step of rounding, every run is
/// rounded alike, and of the variance step^2 / 12 a part repeats and stays (RepeatedByRounding). Uncertainties that
/// were estimated come from the mean itself.
void ScaleToMean(const std::vector<Reading>& used, LinearRun& run);

}  // namespace twinbench::diagnose
