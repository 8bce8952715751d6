#pragma once

#include <Eigen/Core>

#include "twin/diagnose/engine/linear_run.h"

/// Time courses that causes follow: one value a reading, dimensionless or in SI, before any amplitude.
namespace twinbench::diagnose::rotary {

/// t (1 + c (1 - t / 1 h)): a drift whose quadratic share is zero at 0 and 1 h [s].
Eigen::VectorXd DriftSignal(const Schedule& s, double curvature);

/// log(1 + t / tau) since the first reading of the set-up; a different start only changes tau and a constant.
/// @param calibration_too  False: the calibration was made on a mounting that had settled.
Eigen::VectorXd CreepSignal(const Schedule& s, double time_constant_s, bool calibration_too = true);

/// Temperature above `reference_degC`, behind the record by a first-order lag; starts in equilibrium [K].
Eigen::VectorXd LaggedTemperature(const Schedule& s, double reference_degC, double lag_s);

/// Direction of travel in full circles, 0 elsewhere: a goniometer's sweep does not turn the tables.
Eigen::VectorXd DirectionSignal(const Schedule& s);

/// Direction times exp(-t / tau), t the time since the move ended: the in-position window and the dwell.
Eigen::VectorXd SettlingSignal(const Schedule& s, double settle_s, double time_constant_s);

/// sin and cos of 2 pi f t, readings x 2.
Eigen::MatrixXd ToneSignal(const Schedule& s, double frequency_Hz);

/// 1 from the running reading number `onset` on.
Eigen::VectorXd StepSignal(const Schedule& s, int onset);

/// Target angle with its turns counted on: where a pass goes on in the direction of the one before, the recorded
/// angle may have been rewound by a turn. Starts anew in every set-up unless `through_setups`.
Eigen::VectorXd ContinuedTarget_rad(const Schedule& s, bool through_setups);

/// Way that the target has travelled up to each reading, whatever its direction.
Eigen::VectorXd TravelledTarget_rad(const Schedule& s);

/// 1 in full circles, 0 elsewhere.
Eigen::VectorXd InCircle(const Schedule& s);

/// Rows of a pattern: weight of each channel times the signals (readings x k -> rows x k).
Eigen::MatrixXd OnChannels(const Eigen::MatrixXd& signals, const Eigen::VectorXd& weight);

}  // namespace twinbench::diagnose::rotary
