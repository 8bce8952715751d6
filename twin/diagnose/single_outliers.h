#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// Readings that are far from both of their neighbours' levels: disturbed for no lasting reason, and left out before
/// neighbours are taken together.
struct SingleOutliers {
  std::vector<int> readings;  // running numbers
  double size = 0.0;          // rms, SI
  double log_bayes = 0.0;     // against white noise
  int of = 0;                 // readings that were looked at
};

/// Looks for single values of a channel that lie far outside, against the three before and the three behind them: a
/// step or a wave is near the one or the other. What is far is told by how all readings scatter so. Finds none if the
/// noise as a whole has heavy tails.
/// @param left  One entry a reading, SI.
SingleOutliers FindSingleOutliers(const Schedule& schedule, const std::string& channel, const Eigen::VectorXd& left);

}  // namespace twinbench::diagnose
