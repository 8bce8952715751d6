#pragma once

#include <Eigen/Core>

namespace twinbench::model {

/// A quantity that wanders slowly and was read with known noise, as it most probably was: the smoother of a random
/// walk (Rauch, Tung & Striebel, AIAA J. 3 (1965) 1445-1450), its rate taken from the differences of the readings.
///
/// @param time_s  Not decreasing, one a reading.
/// @param shown   Finite.
/// @param noise   Standard deviation of one reading; 0: returned as it is.
Eigen::VectorXd Smoothed(const Eigen::VectorXd& time_s, const Eigen::VectorXd& shown, double noise);

}  // namespace twinbench::model
