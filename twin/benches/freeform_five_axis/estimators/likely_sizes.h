#pragma once

#include <Eigen/Core>
#include <vector>

/// How large unknowns that are thought to be about zero are, by what the readings show.
namespace twinbench::benches::freeform::estimators {

/// How large values that are thought to be about zero are (standard deviation), in residuals: what is most likely
/// by what the free terms leave (restricted likelihood), within a quarter; 0: none of them is needed.
/// @param least_gain  Of the logarithm of the likelihood: with less none is needed.
double LikelySize(const Eigen::MatrixXd& free, const Eigen::MatrixXd& believed, const Eigen::VectorXd& shifts_um,
                  double least_gain = 0.0);

struct LikelySizesFound {
  Eigen::VectorXd sizes;
  double log_likelihood = 0.0;  // restricted, but for what is the same of all beliefs about the same readings
};

/// The same of groups at once, for one of many values may be far larger than the others: sizes of all columns, none
/// below its least one. By MacKay's fixed point: the squares of a group's values by how many of them the readings
/// tell.
/// @param groups  Of each believed column.
LikelySizesFound LikelySizes(const Eigen::MatrixXd& free, const Eigen::MatrixXd& believed,
                             const std::vector<int>& groups, const Eigen::VectorXd& least,
                             const Eigen::VectorXd& shifts_um);

}  // namespace twinbench::benches::freeform::estimators
