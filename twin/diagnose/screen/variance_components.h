#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/screen/sample.h"

namespace twinbench::diagnose::screen {

/// Offsets that readings of one group share, drawn anew for each group: their variance beside that of single
/// readings, in units of the stated noise of the channel.
struct VarianceComponents {
  Eigen::VectorXd variance;    // one a sorting; 0 where the free unknowns absorb it
  Eigen::VectorXd u_variance;  // standard uncertainties; NaN where it is absorbed
  double repeat = kNaN;        // what single readings add: 1 if the stated noise is all there is
};

/// Restricted maximum likelihood (Patterson and Thompson, Biometrika 58 (1971) 545-554), all sortings together, by
/// Fisher scoring on one channel of the run; what the free unknowns can absorb has no part in the likelihood.
///
/// @param sortings  For each sorting the group of every reading, 0, 1, ...; the cost goes with the cube of all
/// groups. Left out: what the projection moves from channel to channel.
VarianceComponents FitVarianceComponents(const Sample& sample, const std::vector<std::vector<int>>& sortings,
                                         int channel);

}  // namespace twinbench::diagnose::screen
