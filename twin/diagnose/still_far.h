#pragma once

#include <vector>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// Of rows that seemed to be far outside, those that are in the end. Where noise goes on from reading to reading, one that is far makes its
/// neighbours look so.
/// @param left  What nothing explains, of every row.
std::vector<int> StillFar(std::vector<int> rows, const LinearRun& run, const Eigen::VectorXd& left);

/// Rms of the largest of each reading, in units of its stated noise.
double SizeOfFar(const std::vector<int>& rows, const LinearRun& run, const Eigen::VectorXd& left);

}  // namespace twinbench::diagnose
