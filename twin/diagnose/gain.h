#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "twin/core/table_errors.h"
#include "twin/diagnose/diagnose.h"

/// What a model with the accepted causes gains over one without: on readings that it was not fitted to, and in the
/// separated errors.
namespace twinbench::diagnose {

/// Which readings are predicted together from all others.
///
/// Fold k leaves out the k-th full-circle pass of every set-up that has more than one, so that tables and mountings
/// stay determined and neighbours, which share their drift, stay together. Of the other phases, and of full circles
/// where no set-up has a second pass, it leaves out every fourth (n-th, of n folds) block of six consecutive
/// readings: what a sweep shows is predicted from the rest of the sweeps.
struct Folds {
  std::vector<int> of_reading;  // one a reading; -1: always in the fit
  int count = 0;
};
Folds MakeFolds(const Schedule& schedule);

/// Predicts held-out passes from the others, with and without the accepted causes.
///
/// In every fold the free unknowns (with their priors) and the amplitudes (prior_sd as prior) are fitted to the
/// other rows; shapes stay as accepted. Rows count with weight 1 / sigma^2. Rows that the others do not determine
/// are left out. noise_floor is what a model that knows the causes exactly would leave: the rows' noise and the
/// uncertainty of the unknowns.
///
/// fraction_removed = removed / (removed + remaining) with removed = MSE before - MSE after and remaining = MSE
/// after - floor^2; a remainder within two standard deviations of what noise alone would scatter counts as zero,
/// because nobody could remove it. Without a positive gain it is removed / (MSE before - floor^2), NaN where that
/// is not above zero. The interval is a paired bootstrap over blocks of six consecutive readings of a set-up and
/// pass, 1000 draws from Stream(1, "diagnose.gain"), in which any positive remainder counts: its lower end is the
/// cautious figure. `positive` says that `removed` is above zero in 97.5 % of the draws.
///
/// @return folds = 0 and NaN if nothing was accepted or nothing can be held out.
/// Not included: that the causes were chosen, and their shapes fitted, on all readings.
Gain MeasureGain(const LinearRun& run, const NoiseModel& noise, const std::vector<Accepted>& accepted);

/// By how much the accepted causes move the separated errors of a rotary bench, rms over the positions [rad, m].
/// Components that nobody reads are NaN. What cannot be separated stays zero in both and does not count.
struct ChangeOfUnknowns {
  std::array<double, kComponents> target_rms, reference_rms;  // by Component
};

/// @param positions  n; the unknowns begin with the 9 n table errors in the order of separate::Design::Column.
ChangeOfUnknowns ChangeOfTables(const LinearRun& run, const NoiseModel& noise,
                                const std::vector<Accepted>& accepted, int positions);

}  // namespace twinbench::diagnose
