#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/separate/series.h"

namespace twinbench::separate::hob {

/// Adds to the covariance of each order what rounding repeats in readings at these angles of the table.
/// @param waves  RoundingWaves of what was rounded there, as the table turns meanwhile [rad]; a row an angle.
/// @return [k - 1]: of the variance of either part of order k (their mean) [rad^2].
std::vector<double> AddRounding(const Eigen::VectorXd& th_rad, const Eigen::MatrixXd& waves,
                                harmonics::HarmonicSeries& series);

}  // namespace twinbench::separate::hob
