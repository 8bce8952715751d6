#pragma once

#include <Eigen/Core>

#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

/// An error curve that no few causes explain, at targets that are approached from both sides again and again: ISO
/// 230-2 leaves every target an error of its own, and finds the reversal beside it.
namespace twinbench::diagnose::encoder {

/// Which target a reading is at: readings x targets. Empty unless a device at rest was brought to every target at
/// least twice from either side.
Eigen::MatrixXd Targets(const SignalContext& context);

/// The causes that were found leave errors that are the same at every visit of a target, or have no name for them.
bool LeaveErrorsOfTargets(const LargeCauses& large, const Eigen::MatrixXd& targets);

/// Where all but a few targets lie on a smooth curve, or most of them on a few orders, as well as their noise lets see: the others,
/// a place that is worn or dirty. Otherwise all.
/// @return readings x targets.
Eigen::MatrixXd TargetsThatStandOut(const EncoderRun& encoder, const Eigen::MatrixXd& targets);

/// The error of every target, as what is left beside the causes; nothing if the search did not leave them free.
/// Call behind AddLargeCauses.
void AddErrorsOfTargets(const LargeCauses& large, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
