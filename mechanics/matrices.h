#pragma once

#include <Eigen/Core>

/// Decompositions of a few dozen rows that are made once for a machine: of one size and in one source, for Eigen's
/// templates cost a compiler more than they cost a run.
namespace twinbench::mechanics {

/// e^a of a square matrix.
Eigen::MatrixXd ExponentialOf(const Eigen::MatrixXd& a);

/// Of a regular matrix.
Eigen::MatrixXd InverseOf(const Eigen::MatrixXd& a);

/// Of a symmetric matrix that has no negative one; two that differ by less than a part in 1e9 count as one.
double LargestEigenvalueOf(const Eigen::MatrixXd& a);

}  // namespace twinbench::mechanics
