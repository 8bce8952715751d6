#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/engine/family.h"

namespace twinbench::diagnose {

/// Prior probabilities: one half for no effect, 0.4 shared evenly by the groups of named causes, 0.1 by those of
/// the unknown; inside a group evenly by family.
inline constexpr double kPriorNone = 0.5;
inline constexpr double kPriorNamed = 0.4;
inline constexpr double kPriorUnknown = 0.1;

/// @return log prior, one a family.
Eigen::VectorXd LogPriors(const std::vector<Family>& families);

/// Log odds that there is any effect at all: log sum prior BF - log prior(none), one a run.
/// @param log_bayes  Families x runs.
Eigen::VectorXd AlarmStatistic(const Eigen::MatrixXd& log_bayes, const Eigen::VectorXd& log_priors);

/// log sum exp of a column.
double LogSum(const Eigen::VectorXd& logs);

}  // namespace twinbench::diagnose
