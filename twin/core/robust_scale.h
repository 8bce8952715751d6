#pragma once

#include <Eigen/Core>
#include <vector>

/// Deviations that half of the values may not move, however far they are off (Rousseeuw & Leroy, Robust Regression and
/// Outlier Detection, 1987, 4.1).
namespace twinbench {

/// Standard deviation of normal values about zero, by the median of their sizes; 0 of none.
double RobustDeviation(std::vector<double> values);
double RobustDeviation(const Eigen::Ref<const Eigen::VectorXd>& values);

/// Standard deviation of white noise on a smooth course of equal steps, by its second differences; 0 of fewer than three.
double RobustNoiseOnCourse(const std::vector<double>& course);

}  // namespace twinbench
