#pragma once

#include <Eigen/Core>

/// Decompositions of a few dozen rows that are made once for a machine: of one size and in one source, for Eigen's
/// templates cost a compiler more than they cost a run.
namespace twinbench::mechanics {

/// e^a of a square matrix.
Eigen::MatrixXd ExponentialOf(const Eigen::MatrixXd& a);

/// Rising; `a` is symmetric.
Eigen::VectorXd EigenvaluesOfSymmetric(const Eigen::MatrixXd& a);

}  // namespace twinbench::mechanics
