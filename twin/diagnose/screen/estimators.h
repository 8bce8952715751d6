#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/screen/sample.h"

/// What some tests of the screen estimate, with a test of its own each.
namespace twinbench::diagnose::screen {

/// Allan variance of means over `length` samples in a row: half the mean square of the difference of neighbouring
/// means that do not overlap, within each series; NaN if none holds two means. White noise: variance / length.
/// Flicker: the same at all lengths. Random walk and drift: growing.
/// Reference: Allan, Proc. IEEE 54 (1966) 221-230.
///
/// @param series  One sample after the other, without a gap; a rest shorter than `length` is left out.
double AllanVariance(const std::vector<Eigen::VectorXd>& series, int length);

/// Sums over readings of series * exp(-i 2 pi f (time - first time)) at f = step, 2 step, ..., count * step: cosine
/// in the real part, minus sine in the imaginary one. Times may be uneven.
///
/// @param series  Readings x columns.
/// @return count x columns, to 1e-6 of the root of readings times the norm of a column.
///
/// Each value is spread over a regular grid by a Gaussian whose transform is divided out after the FFT, so that it
/// costs readings + count log count a column. Source: Greengard and Lee, SIAM Review 46 (2004) 443-454.
Eigen::MatrixXcd Spectrum(const Eigen::VectorXd& time_s, const Eigen::MatrixXd& series, double step_Hz, int count);

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
