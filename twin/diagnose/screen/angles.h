#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose::screen {

/// An angle that errors may be locked to.
struct AngleArgument {
  std::string name;  // "target angle"
  Eigen::VectorXd angle_rad;
};

/// Target, reference, their sum and difference, as far as they were recorded and vary.
std::vector<AngleArgument> AnglesOf(const LinearRun& run);

/// Orders that the stops can tell apart: up to half the number of different angles within a turn, at most 16.
int HighestOrder(const Eigen::VectorXd& angle_rad);

/// cos(order * angle), sin(order * angle) side by side, readings x (2 * orders).
Eigen::MatrixXd Harmonics(const Eigen::VectorXd& angle_rad, const std::vector<double>& orders);

/// 1, 2, ..., highest.
std::vector<double> OrdersUpTo(int highest);

}  // namespace twinbench::diagnose::screen
