#pragma once

#include <map>

#include "twin/diagnose/engine/take_best.h"

/// Causes that are waves and show the same: which of them it is these readings do not tell.
namespace twinbench::diagnose {

/// Of the waves that show the same as the named one that explains most, those with a name explain as much as the best:
/// that one is bent a little otherwise is no evidence, nor is the size that it was thought to have. Where one has just this order, one
/// that may have any stands back by the number of them. Those without a name stand behind them.
/// @param shapes  Of families that were moved to their best shape.
void LevelOneWave(const SearchProblem& problem, const Deflation& others, const Projected& data,
                  const std::map<int, Eigen::VectorXd>& shapes, Evidence& evidence);

}  // namespace twinbench::diagnose
