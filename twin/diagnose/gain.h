#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/diagnose.h"

/// What a model with the accepted causes gains over one without, on readings that it was not fitted to.
namespace twinbench::diagnose {

/// Predicts held-out passes from the others, with and without the accepted causes.
///
/// In every fold the free unknowns (with their priors) and the amplitudes (prior_sd as prior) are fitted to the
/// other rows; shapes stay as accepted. What is then predicted is what the written scenario shows, moved on by what
/// the amplitudes differ from those of all readings; structure that it repeats at its own readings only (extend.h)
/// predicts nothing. Rows count with weight 1 / sigma^2. Rows that the others do not determine
/// are left out. noise_floor is what a model that knows the causes exactly would leave: the rows' noise and the
/// uncertainty of the unknowns.
///
/// Where a fold leaves an amplitude less than 0.3 of its information, because the cause shows in one pass only (a
/// step near the end, a direction that was driven once), no other pass can tell of it: the run is then predicted by
/// blocks of time instead (FoldsOfTime), if they leave more.
///
/// How before, after and floor become fraction_removed and its interval: held_out.h.
///
/// another_run: what is expected without the tables of this run, by reading or by time.
///
/// @param written  What the written scenario takes from the residual, by row [SI].
/// @return folds = 0 and NaN if nothing was accepted or nothing can be held out.
/// Not included: that the causes were chosen, and their shapes fitted, on all readings.
Gain MeasureGain(const LinearRun& run, const NoiseModel& noise, const std::vector<Accepted>& accepted,
                 const Eigen::VectorXd& written);

/// What the accepted causes themselves take from it, as fitted.
Eigen::VectorXd ShownByFit(const LinearRun& run, const std::vector<Accepted>& accepted);

}  // namespace twinbench::diagnose
