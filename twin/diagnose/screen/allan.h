#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::diagnose::screen {

/// Allan variance of means over `length` samples in a row: half the mean square of the difference of neighbouring
/// means that do not overlap, within each series; NaN if none holds two means.
///
/// White noise: variance / length. Flicker: the same at all lengths. Random walk and drift: growing.
/// Reference: Allan, Proc. IEEE 54 (1966) 221-230.
///
/// @param series  One sample after the other, without a gap; a rest shorter than `length` is left out.
double AllanVariance(const std::vector<Eigen::VectorXd>& series, int length);

}  // namespace twinbench::diagnose::screen
