#pragma once

#include <Eigen/Core>

#include "twin/benches/encoder_comparison/estimators/turn_orders.h"

namespace twinbench::separate::encoder {

/// What torque and friction do to turns beyond what goes as the inverse square of the speed: a spindle that is slower here than there is moved more
/// here. Of a torque that takes w of the energy, the speed is v0 sqrt(1 + 2 w), and a turn's angles stand beside a steady course by the integral
/// of 1 / that over its mean.
///
/// @param by_model  Torque and friction as rows of the model's columns, each order a column (the ring's row is not read).
/// @return turns x orders, zero where there is no torque.
Eigen::MatrixXcd BeyondInverseSquare(const TurnModel& model, const Eigen::MatrixXcd& by_model);

/// How much of a turn's angle that is at most, without its shape [rad].
double LargestBeyond_rad(const TurnModel& model, const Eigen::MatrixXcd& by_model);

}  // namespace twinbench::separate::encoder
