#pragma once

#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/large_cause.h"

namespace twinbench::diagnose::encoder {

/// Of rows that walk as a whole: the loops whose steps theirs go with, each where it is best. What repeats on each reversal is
/// taken first; a shape in time may follow anything, and takes what does not repeat.
std::vector<LargeCause> LoopsInWalk(const Searched& searched, const Projector& projector);

/// Whether what this shows is surely no piece of the walk that is left beside it.
bool IsSeenInWalk(const Eigen::VectorXd& left, const Eigen::VectorXd& shown, const std::vector<int>& setup);

}  // namespace twinbench::diagnose::encoder
