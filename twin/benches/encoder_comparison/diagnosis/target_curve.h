#pragma once

#include "twin/benches/encoder_comparison/diagnosis/signals.h"
#include "twin/diagnose/extend.h"

namespace twinbench::diagnose::encoder {

/// Mean of one value a reading at each target.
/// @param targets  Readings x targets: 1 where a reading is at one.
Eigen::VectorXd AtTargets(const Eigen::MatrixXd& targets, const Eigen::VectorXd& values);

/// How far values are off a smooth curve that most of them lie on: cosines of half periods over the travel, fitted with
/// Tukey's weights (Beaton and Tukey, Technometrics 16, 1974).
Eigen::VectorXd OffSmoothCurve(const Eigen::VectorXd& target_rad, const Eigen::VectorXd& error_rad, Eigen::Index waves);

/// The same of a few orders of the angle, as many as make what most values are off clearly smaller.
Eigen::VectorXd OffFewOrders(const Eigen::VectorXd& target_rad, const Eigen::VectorXd& error_rad);

/// A structure without a name that is no more than its values, one a reading.
Accepted ErrorCurve(const Eigen::VectorXd& error_rad);

/// Errors of targets as a structure without a name, and as waves of the device's angle that a twin can carry out:
/// cosines of half periods over the travel, one a target, which pass through all of them.
/// @param error_rad  One a reading, the same at every visit.
Accepted CurveThrough(const SignalContext& context, const Eigen::MatrixXd& targets, const Eigen::VectorXd& error_rad);

}  // namespace twinbench::diagnose::encoder
