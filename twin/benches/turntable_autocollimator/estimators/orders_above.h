#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::separate::turntable {

/// Orders of a curve that were not fitted and stand out of what the fit leaves.
struct OrdersAbove {
  std::vector<int> orders;     // ascending
  double variance_rad2 = 0.0;  // of the curve that they make
};

/// One order after the other, the one that stands out most first: each as far as the fit cannot make its waves, against
/// the middle one of all (white residuals: chi-squared of 2 degrees of freedom).
///
/// @param fitted     Orthonormal columns of all that was fitted, one row a reading.
/// @param angle_rad  One a reading.
/// @param first, last  Orders that are looked at; nothing is said of fewer than six.
OrdersAbove FindOrdersAbove(const Eigen::MatrixXd& fitted, const Eigen::VectorXd& angle_rad, Eigen::VectorXd residual_rad,
                            int first, int last);

}  // namespace twinbench::separate::turntable
