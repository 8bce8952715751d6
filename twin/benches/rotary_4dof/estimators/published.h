#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/separate.h"

/// Equations 13-27 of Jywe et al. (2007): two full circles, the reference one step further in the second.
///
/// Every component is a scalar sum of target and reference error at the same stop (eqs. 13, 22, 23), in L. The
/// signs in front of the reference differ between the printed equations; here all are plus, which makes the result
/// the reference's own error. Index i counts the stops in the paper's sense of turning (its target turns
/// clockwise), so that the second test pairs target i with reference i + 1. Position values are deviations whose
/// sum is zero (eq. 24); for ez the unknowns are sector angles, and the printed 360 deg is the sum of the nominal
/// sectors, so their deviations also sum to zero (eq. 20). Sectors are differences of the readings from stop to
/// stop and are added up again at the end.
///
/// Eq. 19 (closure) holds only if both tests have the same constant; each test's mean is taken away first, for
/// every component, as eq. 9 does for dy: otherwise a mounting constant would come back as a ramp.
///
/// What is wrong with it, on purpose: for `reclamp` the wobble and radial equations neglect that the reference has
/// another azimuth in the second test; a lab-frame harmonic k of the reference comes out wrong by about 1/|k| of
/// its amplitude (docs/theory.md 3.1). Dropping a row costs sqrt 2 in noise against least squares (2).
namespace twinbench::separate {

/// The printed system (21): n equations t_i + r_i = m1_i, then t_i + r_{i+1} = m2_i without the last one, which
/// depends on the others, and sum r = 0 instead. Unknowns [t; r], 2n x 2n.
Eigen::MatrixXd PublishedMatrix(int n);

/// [t; r] by Gaussian elimination for each column of the two tests, n rows each.
Eigen::MatrixXd SolvePublished(const Eigen::MatrixXd& test_1, const Eigen::MatrixXd& test_2);

/// The method on measured motions: the first two set-ups whose shifts differ by one step, means over the passes.
/// Readings at a stop that has none in one of the two tests make the result NaN, with a note: the elimination has
/// no redundancy to spare. Uncertainty: propagated from the motions' covariances; not included: everything in the
/// paragraph on what is wrong.
/// @throws InputError if no two set-ups differ by one step.
Separation SeparatePublished(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                             const LayoutOptions& options);

}  // namespace twinbench::separate
