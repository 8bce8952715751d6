#pragma once

#include <Eigen/Core>
#include <vector>

/// What no cause explains goes on from one reading to the next: sizes that are fitted beside it are less sure than white
/// noise would leave them.
namespace twinbench::diagnose::encoder {

/// How many readings say as much as one would of white noise, by the correlation of neighbours within passes.
/// @param left  What is left, whitened, one a reading.
double MemoryOf(const Eigen::VectorXd& left, const std::vector<int>& pass);

/// By how much the variance of a size is larger than white noise would have it: from what stretches of the record say
/// of the size, each by itself (the robust variance of clustered errors, Liang and Zeger 1986). Sees what goes on for
/// longer than neighbours tell: a random walk.
/// @param signal  By reading, whitened as `left` is.
double MemoryAlong(const Eigen::VectorXd& signal, const Eigen::VectorXd& left);

}  // namespace twinbench::diagnose::encoder
