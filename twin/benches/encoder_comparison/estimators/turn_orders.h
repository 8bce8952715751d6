#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/coast_passes.h"
#include "twin/benches/encoder_comparison/estimators/time_reversal.h"

/// What turns of a coasting spindle have in common, order by order.
namespace twinbench::separate::encoder {

/// Turns as rows of a linear model, the same for every order: 1 for the ring, (reference speed / speed)^2 for a
/// torque, the same with the sense of rotation for friction, as far as the turns tell these apart.
struct TurnModel {
  Eigen::MatrixXd columns;
  Eigen::VectorXd weight;  // 1 / speed^2: times are as uncertain at any speed
  double reference_speed_rad_s = kNaN;
  int torque = -1, friction = -1;  // their columns; -1: none
};
TurnModel ModelOf(const std::vector<CoastTurn>& turns);

/// Pools each order with `pooled` neighbours on either side.
Eigen::VectorXd Pooled(const Eigen::VectorXd& of_order, int pooled);

/// Lines show a ring's error where they stand on an ideal ring; this is by the angle at which they are. What
/// that leaves out, as many orders as before being kept, is of one order more in the slope of the curve; its
/// covariance has it.
void SetByOwnAngle(harmonics::HarmonicSeries& ring);

/// Beginning of a result: counts, or why there is no curve.
TimeReversal BeginCoast(const CoastPasses& coast);

/// Below half the lines.
int HighestCoastOrder(const CoastPasses& coast, const CoastOptions& options);

}  // namespace twinbench::separate::encoder
