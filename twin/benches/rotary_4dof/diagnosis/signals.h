#pragma once

#include <Eigen/Core>

#include "twin/diagnose/engine/linear_run.h"

/// Time courses that causes follow: one value a reading, dimensionless or in SI, before any amplitude.
namespace twinbench::diagnose::rotary {

/// Direction of travel in full circles, 0 elsewhere: a goniometer's sweep does not turn the tables.
Eigen::VectorXd DirectionSignal(const Schedule& s);

/// Direction times exp(-t / tau), t the time since the move ended: the in-position window and the dwell.
Eigen::VectorXd SettlingSignal(const Schedule& s, double settle_s, double time_constant_s);

/// Target angle with its turns counted on: where a pass goes on in the direction of the one before, the recorded
/// angle may have been rewound by a turn. Starts anew in every set-up unless `through_setups`.
Eigen::VectorXd ContinuedTarget_rad(const Schedule& s, bool through_setups);

/// 1 in full circles, 0 elsewhere.
Eigen::VectorXd InCircle(const Schedule& s);

/// Rows of a pattern: weight of each channel times the signals (readings x k -> rows x k).
Eigen::MatrixXd OnChannels(const Eigen::MatrixXd& signals, const Eigen::VectorXd& weight);

}  // namespace twinbench::diagnose::rotary
