#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/engine/family.h"

namespace twinbench::diagnose {

/// tuning::kPriorNone and its like, shared out.
/// @return log prior, one a family.
Eigen::VectorXd LogPriors(const std::vector<Family>& families);

/// Log odds that there is any effect at all: log sum prior BF - log prior(none), one a run.
/// @param log_bayes  Families x runs.
Eigen::VectorXd AlarmStatistic(const Eigen::MatrixXd& log_bayes, const Eigen::VectorXd& log_priors);

/// log sum exp of a column.
double LogSum(const Eigen::VectorXd& logs);

}  // namespace twinbench::diagnose
